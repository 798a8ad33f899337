// The page around a world: a socket to the server that serves this very file, and back again after a reload.
import { mount } from "./world.js";

const address = new URL("socket", location.href);
address.protocol = "ws:";

let socket = null;
let wait = 250;

const world = mount(document.getElementById("world"), {
  send(message) {
    if (socket?.readyState === WebSocket.OPEN) socket.send(JSON.stringify(message));
  },
  keys: document,
  named(title) {
    document.title = `${title} · sandbox`;
  },
});

function connect() {
  socket = new WebSocket(address);
  socket.binaryType = "arraybuffer";
  socket.onopen = () => {
    wait = 250;
    watch();
  };
  socket.onmessage = (event) => world.receive(event.data);
  socket.onclose = () => {
    world.lost("The course is not running any more, or is out of reach. Trying again …");
    setTimeout(connect, wait);
    wait = Math.min(wait * 2, 8000);
  };
}

// The world waits while its page cannot be seen.
function watch() {
  if (socket.readyState === WebSocket.OPEN) socket.send(JSON.stringify({ do: "watch", on: !document.hidden }));
}

document.addEventListener("visibilitychange", watch);
connect();
