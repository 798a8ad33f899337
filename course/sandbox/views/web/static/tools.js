// Hands: what a pointer, fingers and keys do to a world. Everything goes out as a request; no physics is in here.
import { distance, short, spoken } from "./camera.js";

/** What the terminal can do too has the same key there. */
export const KEYS = [
  ["Space", "run, pause"],
  [", .", "a picture back, on"],
  ["< >", "half a second back, on"],
  [":", "one step of the solver"],
  ["X", "to the next contact"],
  ["R", "back to the start"],
  ["J, K", "play backwards, back to now"],
  ["U, Shift+U", "undo, redo"],
  ["N, Shift+N", "next, previous body"],
  ["Arrows", "push the body; while paused, place it; drive what has wheels; without a body, move the view"],
  ["Shift+Arrows", "the same, more of it"],
  ["Enter", "its numbers; in the past: go on from here"],
  ["Y, Delete", "copy it, take it away"],
  ["Z, T", "follow it, trace it"],
  ["C, B", "a new ball, box"],
  ["S", "stop everything"],
  ["+, −, 0", "closer, farther, all of it"],
  ["W, Shift+Z", "walls, the run before"],
  ["P", "predict"],
  ["O", "all scenes"],
  ["Esc", "choose no body"],
];
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

export class Tools {
  constructor(view, camera, canvas) {
    this.view = view;
    this.camera = camera;
    this.fingers = new Map();
    this.count = 0;
    canvas.addEventListener("pointerdown", (event) => this.down(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    canvas.addEventListener("pointerup", (event) => this.up(event, true));
    canvas.addEventListener("pointercancel", (event) => this.up(event, false));
    canvas.addEventListener("dblclick", (event) => {
      const [x, y] = camera.place(event);
      if (!this.pick(x, y, this.reach(event))) view.send({ do: "spawn", shape: event.shiftKey ? "box" : "circle", x, y });
    });
    canvas.addEventListener(
      "wheel",
      (event) => {
        event.preventDefault();
        camera.zoomBy(Math.exp(-event.deltaY * (event.deltaMode ? 0.05 : 0.0015)), event);
        view.moved();
      },
      { passive: false },
    );
  }

  reach(event) {
    return (event.pointerType === "mouse" ? 10 : 26) / this.camera.scale;
  }

  /** The movable body nearest to a place, if it is near enough. */
  pick(x, y, reach) {
    const { view } = this;
    if (!view.frame) return null;
    let best = null;
    let least = reach;
    view.bodies.forEach((body, i) => {
      if (body.fixed) return;
      const [bx, by, angle] = view.row(i);
      const [c, s] = [Math.cos(angle), Math.sin(angle)];
      const far = distance(body, c * (x - bx) + s * (y - by), -s * (x - bx) + c * (y - by));
      if (far <= least) [best, least] = [body.name, far];
    });
    return best;
  }

  /** Where the handle of a body's arrow is: at its tip, or beside a body that stands. */
  tip(body, x, y, dx, dy) {
    const size = Math.hypot(dx, dy);
    const least = (body.radius || Math.max(...body.outline.map((p) => Math.hypot(...p)))) + 14 / this.camera.scale;
    if (size >= least) return [x + dx, y + dy];
    return size > 0 ? [x + (dx / size) * least, y + (dy / size) * least] : [x + least, y];
  }

  aims(x, y, reach) {
    const { view } = this;
    const row = view.chosen && view.state.paused && view.rowOf(view.chosen);
    if (!row) return false;
    const body = view.bodies.find((b) => b.name === view.chosen);
    const [tx, ty] = this.tip(body, row[0], row[1], row[3] / view.gain, row[4] / view.gain);
    return Math.hypot(tx - x, ty - y) <= Math.max(reach, 12 / this.camera.scale);
  }

  /** A tap opens the body's numbers, unless they would lie on what a hand takes hold of. */
  tap(card) {
    const { view } = this;
    const row = view.rowOf(view.chosen);
    const body = view.bodies.find((b) => b.name === view.chosen);
    if (!row || !body) return;
    card.open = true;
    const { left, top, right, bottom } = card.getBoundingClientRect();
    const [x0, y0] = this.camera.place({ clientX: left, clientY: bottom });
    const [x1, y1] = this.camera.place({ clientX: right, clientY: top });
    const under = ([x, y]) => x > x0 && x < x1 && y > y0 && y < y1;
    const tip = this.tip(body, row[0], row[1], row[3] / view.gain, row[4] / view.gain);
    card.open = !(under(tip) || under(row));
  }

  down(event) {
    const { view } = this;
    this.fingers.set(event.pointerId, event);
    if (this.fingers.size === 2) this.pinch = this.spread();
    if (!view.frame || view.pointer || event.button > 1) return;
    const [x, y] = this.camera.place(event);
    const reach = this.reach(event);
    const aim = this.aims(x, y, reach);
    const name = aim ? view.chosen : event.button === 1 ? null : this.pick(x, y, reach);
    event.preventDefault();
    view.canvas.focus({ preventScroll: true });
    view.canvas.setPointerCapture(event.pointerId);
    if (!aim) view.choose(name);
    view.pointer = { id: event.pointerId, name, x, y, from: [event.clientX, event.clientY], gain: view.gain, pan: !name };
    if (name && view.state.at === null) {
      const row = view.rowOf(name);
      if (aim) view.pointer.aim = true;
      else if (view.state.paused) view.pointer.offset = [row[0] - x, row[1] - y];
      else view.send({ do: "grab", x, y, reach });
    }
  }

  spread() {
    const [a, b] = [...this.fingers.values()];
    return { far: Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY), clientX: (a.clientX + b.clientX) / 2, clientY: (a.clientY + b.clientY) / 2 };
  }

  move(event) {
    const { view, camera } = this;
    if (this.fingers.has(event.pointerId)) this.fingers.set(event.pointerId, event);
    if (this.fingers.size === 2) {
      if (view.pointer && !view.pointer.pan) return;
      const now = this.spread();
      const [x, y] = camera.place(this.pinch);
      const [nx, ny] = camera.place(now);
      camera.pan(x - nx, y - ny);
      camera.zoomBy(now.far / (this.pinch.far || 1), now);
      this.pinch = now;
      view.moved();
      return;
    }
    const { pointer } = view;
    if (!pointer || pointer.id !== event.pointerId) {
      if (view.frame && event.pointerType === "mouse") {
        const [x, y] = camera.place(event);
        view.canvas.classList.toggle("over", this.aims(x, y, 0) || this.pick(x, y, this.reach(event)) !== null);
      }
      return;
    }
    pointer.moved ||= Math.hypot(event.clientX - pointer.from[0], event.clientY - pointer.from[1]) > 6;
    if (!pointer.moved) return;
    const [x, y] = camera.place(event);
    if (pointer.pan) {
      camera.pan(pointer.x - x, pointer.y - y);
      view.followed = null;
      view.moved();
      return;
    }
    [pointer.x, pointer.y] = [x, y];
    if (pointer.offset) {
      view.later("place", { do: "place", name: pointer.name, x: x + pointer.offset[0], y: y + pointer.offset[1] });
    } else if (!pointer.aim && view.state.at === null) view.later("drag", { do: "drag", x, y });
    view.changed = true;
  }

  up(event, meant) {
    const { view } = this;
    const { pointer } = view;
    this.fingers.delete(event.pointerId);
    if (!pointer || pointer.id !== event.pointerId) return;
    view.flush();
    if (pointer.aim) {
      const row = view.rowOf(pointer.name);
      if (meant && pointer.moved && row) {
        const [vx, vy] = [(pointer.x - row[0]) * pointer.gain, (pointer.y - row[1]) * pointer.gain];
        view.send({ do: "aim", name: pointer.name, vx, vy });
      }
    } else if (!pointer.pan && !pointer.offset) view.send({ do: "release" });
    if (meant && !pointer.moved && pointer.name) this.tap(view.body.element);
    view.pointer = null;
    view.changed = true;
  }

  // -- keys ---------------------------------------------------------------------------------------

  key(event) {
    const { view } = this;
    if (!view.frame || view.gallery.isOpen || event.altKey) return;
    const at = event.target;
    const slides = at.type === "range";
    if (at.matches?.("input:not([type=range], [type=checkbox]), select, textarea")) return;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    if (event.ctrlKey || event.metaKey) {
      if (key !== "z" && key !== "y") return;
      view.send({ do: key === "y" || event.shiftKey ? "redo" : "undo" });
      event.preventDefault();
      return;
    }
    // What has the focus keeps the keys that it lives on.
    if (slides && (ARROWS[key] || ["Home", "End", "PageUp", "PageDown"].includes(key))) return;
    if ((key === " " || key === "Enter") && at.matches?.("button, summary, input[type=checkbox]")) return;
    if (ARROWS[key] && at.closest?.("ol, .panel")) return;
    const of = (what) => () => this.chosen() && view.send({ do: what, name: view.chosen });
    const past = view.state.at !== null;
    const act = {
      " ": () => view.toggle(),
      ".": () => view.send({ do: "step", kind: "picture" }),
      ",": () => view.back(),
      "<": () => view.send({ do: "look", t: Math.max(0, view.frame.t - 0.5) }),
      ">": () => past && view.send({ do: "look", t: view.frame.t + 0.5 }),
      ":": () => view.send({ do: "step", kind: "solver" }),
      x: () => view.send({ do: "step", kind: "contact" }),
      r: () => view.send({ do: "reset" }),
      j: () => view.send({ do: "play", way: -1 }),
      k: () => view.send({ do: "look", t: null }),
      u: () => view.send({ do: event.shiftKey ? "redo" : "undo" }),
      n: () => this.next(event.shiftKey ? -1 : 1),
      Enter: () => (past ? view.send({ do: "go" }) : this.chosen() && view.body.open()),
      y: of("copy"),
      Delete: of("remove"),
      Backspace: of("remove"),
      z: () => (event.shiftKey ? view.send({ do: "ghost", on: !view.state.ghost }) : this.chosen() && view.follow()),
      t: () => this.chosen() && view.traceBody(),
      c: () => this.spawn("circle"),
      b: () => this.spawn("box"),
      s: () => view.send({ do: "stop" }),
      "+": () => view.zoom(1.25),
      "=": () => view.zoom(1.25),
      "-": () => view.zoom(0.8),
      0: () => view.zoom(0),
      w: () => view.send({ do: "set", key: "walls", value: view.state.settings.walls ? 0 : 1 }),
      p: () => view.prediction.open(),
      o: () => view.gallery.open(),
      Escape: () => view.choose(null),
    }[key];
    if (ARROWS[key]) this.arrow(...ARROWS[key], event.shiftKey ? 4 : 1);
    else if (act) act();
    else return;
    event.preventDefault();
  }

  chosen() {
    if (!this.view.chosen) this.next(1);
    return this.view.chosen;
  }

  next(way) {
    const { view } = this;
    const names = view.bodies.filter((body) => !body.fixed).map((body) => body.name);
    if (!names.length) return;
    const at = names.indexOf(view.chosen);
    const name = names[at < 0 ? (way > 0 ? 0 : names.length - 1) : (at + way + names.length) % names.length];
    view.choose(name);
    const [x, y, , vx, vy] = view.rowOf(name);
    view.tell(`${spoken(name)}: at x ${short(x)}, y ${short(y)} metres, ${short(Math.hypot(vx, vy))} metres per second.`);
  }

  /** Drive what has wheels, place what stands, push what moves; without a body, move the view. */
  arrow(dx, dy, times) {
    const { view } = this;
    const [left, bottom, right, top] = view.scene.view;
    const wheeled = view.bodies.find((body) => body.wheels && (!view.chosen || body.name === view.chosen));
    if (wheeled) {
      const { left: l, right: r } = view.state.settings;
      const set = (key, value) => view.send({ do: "set", key, value: Math.min(5, Math.max(-5, Number(value.toFixed(3)))) });
      set("left", l + 0.1 * times * (dy + dx));
      set("right", r + 0.1 * times * (dy - dx));
    } else if (!view.chosen) {
      const far = ((right - left) / view.camera.zoom) * 0.03 * times;
      view.camera.pan(dx * far, dy * far);
      view.moved();
    } else if (view.state.paused) {
      const row = view.rowOf(view.chosen);
      const far = (top - bottom) * 0.01 * times;
      const [x, y] = [row[0] + dx * far, row[1] + dy * far];
      view.send({ do: "place", name: view.chosen, x, y });
      view.tell(`${spoken(view.chosen)} to x ${short(x)}, y ${short(y)} metres.`);
    } else {
      const speed = view.gain * (top - bottom) * 0.05 * times;
      view.send({ do: "push", name: view.chosen, vx: dx * speed, vy: dy * speed });
    }
  }

  spawn(shape) {
    const { view } = this;
    const [left, bottom, right, top] = view.scene.view;
    // One beside the other, high up, so that they do not start inside each other.
    const part = (0.5 + 0.618 * this.count++) % 1;
    view.send({ do: "spawn", shape, x: left + (right - left) * (0.15 + 0.7 * part), y: bottom + (top - bottom) * 0.85 });
  }
}
