// The notebook part of world.js, which precedes this: messages instead of a socket.

export default {
  render({ model, el }) {
    // The keys of the world are the world's, not shortcuts of the notebook. JupyterLab looks at what has the focus
    // first, and only then at what is around it.
    el.addEventListener("focusin", (event) => {
      event.target.dataset.lmSuppressShortcuts = "true";
    });
    // The width of the cell, not of the window, decides the layout of the world.
    el.style.containerType = "inline-size";
    const world = mount(el, { send: (request) => model.send({ kind: "request", text: JSON.stringify(request) }) });
    const hear = (message, buffers) => {
      if (message.kind === "numbers") {
        world.receive(buffers[0]);
        model.send({ kind: "seen" });
      } else if (message.kind === "words") world.receive(message.text);
    };
    model.on("msg:custom", hear);
    // The world waits while it is out of sight.
    const watch = (on) => model.send({ kind: "request", text: JSON.stringify({ do: "watch", on }) });
    const observer = new IntersectionObserver((entries) => watch(entries.at(-1).isIntersecting));
    model.send({ kind: "hello" });
    observer.observe(el);
    return () => {
      observer.disconnect();
      model.off("msg:custom", hear);
      model.send({ kind: "bye" });
      world.destroy();
    };
  },
};
