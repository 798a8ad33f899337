// A world as a page shows it. `mount(element, { send, named, keys })` builds everything inside one element; `send` takes
// one request as an object, `receive` what the world answers: JSON text (or an object), and float32 frames; `named`
// is told the scene's title; `keys` is where keys are heard, the element itself if it is left out.
// Nothing is fetched, and nothing outside the element is touched, so a notebook can use these files as they are.
import { Camera, amount, h, nearest, outline, plain, round, short, spoken, stops } from "./camera.js";
import { ENERGY, MOMENTUM, Past, Plot } from "./plots.js";
import { Painter, rowOf } from "./draw.js";
import { Body, Gallery, Prediction } from "./cards.js";
import { KEYS, Tools } from "./tools.js";

const CALM = 2500; // ms between sentences that are spoken
const KEPT = 60; // sentences in the list

export function mount(element, { send, named = () => {}, keys = null }) {
  const view = new View(element, send, named, keys);
  return {
    receive: (data) => view.receive(data),
    lost: (text) => view.say(text, true),
    destroy: () => view.destroy(),
  };
}

class View {
  constructor(element, send, named, keys) {
    this.named = named;
    this.host = element;
    this.send = send;
    this.bodies = [];
    this.version = null;
    this.frame = null;
    this.ghost = { bodies: [], frame: null };
    this.past = new Past();
    this.marks = [];
    this.trace = null; // where a body has been
    this.followed = null; // name of the body that the camera follows
    this.chosen = null; // name of the body that keys act on
    this.pointer = null; // what a pointer is doing
    this.waiting = new Map(); // requests of which only the latest counts
    this.spoke = 0;
    this.unsaid = [];
    this.still = matchMedia("(prefers-reduced-motion: reduce)").matches;
    this.dark = matchMedia("(prefers-color-scheme: dark)");
    this.onScheme = () => this.repaint();
    this.dark.addEventListener("change", this.onScheme);
    this.build();
    this.keys = keys ?? this.root;
    this.onKey = (event) => this.tools.key(event);
    this.keys.addEventListener("keydown", this.onKey);
    this.observer = new ResizeObserver(() => this.fit());
    this.observer.observe(this.canvas);
    this.loop = (now) => {
      this.request = requestAnimationFrame(this.loop);
      this.flush();
      this.draw();
      this.gallery.draw(now);
    };
    this.request = requestAnimationFrame(this.loop);
  }

  destroy() {
    cancelAnimationFrame(this.request);
    this.observer.disconnect();
    this.keys.removeEventListener("keydown", this.onKey);
    this.dark.removeEventListener("change", this.onScheme);
    this.root.remove();
  }

  // -- building -----------------------------------------------------------------------------------

  build() {
    const button = (label, act, more = {}) => h("button", { type: "button", onclick: act, ...more }, label);
    const ask = (request) => () => this.send(request);
    this.title = h("h1");
    this.teaches = h("p", { class: "teaches" });
    // A screen reader would read an output element aloud at every change.
    this.clock = h("span", { class: "clock", role: "timer", "aria-label": "simulated time" });
    this.canvas = h("canvas", { class: "world", tabindex: "0", role: "application" });
    this.canvas.setAttribute("aria-label", "The world. N chooses a body, arrow keys push or place it, Space runs and pauses.");
    this.camera = new Camera(this.canvas);
    this.painter = new Painter(this, this.camera, this.canvas);
    this.tools = new Tools(this, this.camera, this.canvas);
    this.prediction = new Prediction(this);
    this.body = new Body(this);
    this.gallery = new Gallery(this);
    this.tag = h("p", { class: "tag" });
    this.lag = h("p", { class: "lag" });
    this.ruler = h("p", { class: "ruler" }, h("i"), h("span"));
    this.banner = h("p", { class: "banner", role: "alert", hidden: true });
    this.work = h("p", { class: "work", hidden: true }, h("progress", { max: "1", "aria-label": "how far it is" }), h("span"), button("Stop", ask({ do: "cancel" })));
    this.run = button("Run", () => this.toggle(), { class: "main" });
    this.arrows = h("input", { type: "checkbox", onchange: () => (this.changed = true) });
    this.ghostly = h("input", { type: "checkbox", onchange: () => this.send({ do: "ghost", on: this.ghostly.checked }) });
    this.speed = h("input", { type: "range", min: "0", step: "1", id: "speed" });
    this.speedShown = h("span", { class: "value" });
    this.speed.addEventListener("input", () => this.later("speed", { do: "speed", value: this.speeds[this.speed.value] }));
    this.speeds = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 4];
    this.undo = button("Undo", ask({ do: "undo" }));
    this.redo = button("Redo", ask({ do: "redo" }));
    this.line = h("input", { type: "range", id: "line", min: "0", max: "0", step: "any", "aria-label": "Time line" });
    this.line.addEventListener("input", () => {
      this.sought = this.line.valueAsNumber;
      this.later("look", { do: "look", t: this.sought });
    });
    this.line.addEventListener("keydown", (event) => this.lineKey(event));
    this.marked = h("canvas", { "aria-hidden": "true" });
    this.lineShown = h("span", { class: "value" });
    this.goOn = button("Go on from here", ask({ do: "go" }), { disabled: true });
    this.now = button("Back to now", ask({ do: "look", t: null }), { disabled: true });
    this.film = h(
      "select",
      { "aria-label": "Save this run" },
      ...["Save …", "PNG, this moment", "GIF, 640 wide", "GIF, 1280 wide", "MP4, 1280 wide", "MP4, 1920 wide"].map((text, i) =>
        h("option", { value: ["", "png 1280", "gif 640", "gif 1280", "mp4 1280", "mp4 1920"][i] }, text),
      ),
    );
    this.film.addEventListener("change", () => {
      const [kind, width] = this.film.value.split(" ");
      if (kind) this.send({ do: "film", kind, width: Number(width) });
      this.film.value = "";
    });
    this.knobs = h("div", { class: "knobs" });
    this.energy = new Plot("Energy", "in J", ENERGY);
    this.momentum = new Plot("Momentum", "in kg m/s", MOMENTUM);
    this.list = h("ol", { tabindex: "0", "aria-label": "Events, newest first" });
    this.note = h("p");
    this.after = h("p");
    this.live = h("p", { class: "unseen", role: "status", "aria-live": "polite" });
    const time = h(
      "div",
      { class: "time", role: "group", "aria-label": "Time line" },
      button("◀", ask({ do: "play", way: -1 }), { class: "round", "aria-label": "Play backwards", title: "Play backwards (J)" }),
      h("div", { class: "line" }, this.marked, this.line),
      this.lineShown,
      this.goOn,
      this.now,
    );
    const bar = h(
      "div",
      { class: "bar", role: "group", "aria-label": "Time and bodies" },
      this.run,
      h("button", { type: "button", title: "A picture on; Shift: one step of the solver", onclick: (e) => this.send({ do: "step", kind: e.shiftKey ? "solver" : "picture" }) }, "Step"),
      button("Contact", ask({ do: "step", kind: "contact" }), { title: "To the next contact (X)" }),
      button("Reset", ask({ do: "reset" })),
      h("span", { class: "gap" }),
      this.undo,
      this.redo,
      h("span", { class: "gap" }),
      button("+ Ball", () => this.tools.spawn("circle")),
      button("+ Box", () => this.tools.spawn("box")),
      button("Stop all", ask({ do: "stop" }), { title: "Let everything stand still (S)" }),
      this.film,
      h("label", { class: "check" }, this.arrows, "Arrows"),
      h("label", { class: "check" }, this.ghostly, "Run before"),
      h("label", { class: "speed", for: "speed" }, h("span", {}, "Speed"), this.speed, this.speedShown),
    );
    const theme = button("◐", () => this.scheme(), { class: "round", "aria-label": "Dark or light", title: "Dark or light" });
    const keys = KEYS.map(([key, does]) => h("div", {}, h("dt", {}, key), h("dd", {}, does)));
    const zoom = h(
      "div",
      { class: "zoom", role: "group", "aria-label": "View" },
      button("+", () => this.zoom(1.25), { "aria-label": "Closer" }),
      button("−", () => this.zoom(0.8), { "aria-label": "Farther" }),
      button("⤢", () => this.zoom(0), { "aria-label": "All of it" }),
    );
    const panel = h(
      "aside",
      { class: "panel", "aria-label": "Numbers" },
      h("section", {}, h("h2", {}, "Settings"), this.knobs),
      this.energy.element,
      this.momentum.element,
      h("section", { class: "events" }, h("h2", {}, "What happened"), this.list),
      h("details", {}, h("summary", {}, "About this scene"), this.note, this.after, button("Make it mine", ask({ do: "mine" }))),
      h("details", { class: "keys" }, h("summary", {}, "Keys"), h("dl", {}, ...keys)),
    );
    const scenes = button("Scenes", () => this.gallery.open(), { title: "All scenes (O)" });
    const over = [this.prediction.chip, this.prediction.element, this.body.element];
    this.root = h(
      "div",
      { class: "sandbox" },
      h("header", { class: "top" }, this.title, this.clock, scenes, theme, this.teaches),
      h("div", { class: "stage" }, this.canvas, this.tag, this.lag, this.ruler, ...over, zoom, this.work, this.banner),
      time,
      bar,
      panel,
      this.gallery.element,
      this.live,
    );
    // After a click the keys are the world's again; who came by keys stays where they are.
    this.root.addEventListener("click", (event) => {
      if (event.detail && event.target.closest(".bar button, .zoom button, .time button")) this.canvas.focus({ preventScroll: true });
    });
    this.host.replaceChildren(this.root);
  }

  scheme() {
    const dark = this.root.dataset.theme ? this.root.dataset.theme === "dark" : this.dark.matches;
    this.root.dataset.theme = dark ? "light" : "dark";
    this.repaint();
  }

  repaint() {
    this.colours = null;
    this.stale = 0;
    this.changed = true;
  }

  /** A colour of the style sheet, asked for once. */
  colour(name) {
    this.colours ??= { from: getComputedStyle(this.root) };
    return (this.colours[name] ??= this.colours.from.getPropertyValue(name).trim());
  }

  // -- what the world says --------------------------------------------------------------------------

  receive(data) {
    if (data instanceof ArrayBuffer || ArrayBuffer.isView(data)) this.numbers(data);
    else this.words(typeof data === "string" ? JSON.parse(data) : data);
  }

  numbers(data) {
    const bytes = ArrayBuffer.isView(data) ? data.buffer.slice(data.byteOffset, data.byteOffset + data.byteLength) : data;
    const [kind] = new Float32Array(bytes, 0, 1);
    if (kind === 6) return this.save(bytes.slice(4));
    const n = new Float32Array(bytes);
    if (kind === 1) this.shown(n);
    else if (kind === 4) this.gallery.numbers(n);
    else if (kind === 5) this.trace = this.trace && { ...this.trace, rows: rowsOf(n, 2, n[1], 3) };
    else {
      const [, rows, columns] = n;
      if (kind === 3) this.past.clear();
      for (const row of rowsOf(n, 3, rows, columns)) this.past.add(row);
    }
    this.changed = true;
    return undefined;
  }

  shown(n) {
    const [, version, t, pace, count, joints] = n;
    const frame = { t, pace, count, joints, n };
    if (n[21] === 1) {
      this.ghost.frame = version === this.ghost.version && count === this.ghost.bodies.length ? frame : null;
    } else if (version === this.version && count === this.bodies.length) {
      this.frame = frame;
      if (this.trace && !n[23]) this.trace.rows.push([t, ...this.rowOf(this.trace.name)?.subarray(0, 2) ?? [NaN, NaN]]);
    }
  }

  save(bytes) {
    const link = h("a", { download: this.file, href: URL.createObjectURL(new Blob([bytes])) });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
    this.say(`Saved as ${this.file}.`);
  }

  words(message) {
    const hear = {
      scene: () => this.introduce(message),
      bodies: () => this.embody(message),
      status: () => this.status(message),
      events: () => this.happened(message),
      marks: () => (this.marks = message.anew ? message.marks : [...this.marks, ...message.marks]),
      scenes: () => this.gallery.show(message.scenes),
      card: () => this.gallery.card(message),
      file: () => (this.file = message.name),
      error: () => this.say(message.message),
    }[message.type];
    hear?.();
    this.changed = true;
  }

  introduce(scene) {
    const again = this.scene?.id === scene.id; // a reload of the socket keeps what was looked at
    this.scene = scene;
    this.say("");
    this.title.textContent = scene.title;
    this.named(scene.title);
    this.teaches.textContent = scene.teaches;
    this.note.textContent = scene.note;
    this.after.replaceChildren(h("strong", {}, "Think: "), scene.after);
    const [left, bottom, right, top] = scene.view;
    this.root.style.setProperty("--shape", `${right - left} / ${top - bottom}`);
    this.span = Math.min(Math.max(scene.duration, 0.01), 10);
    this.list.replaceChildren();
    this.addLines(scene.events);
    this.marks = scene.marks;
    this.ghost = { bodies: [], frame: null };
    if (!again) [this.trace, this.followed, this.chosen] = [null, null, null];
    if (!this.speeds.includes(scene.status.speed)) {
      this.speeds = [...this.speeds, scene.status.speed].sort((a, b) => a - b);
    }
    this.speed.max = String(this.speeds.length - 1);
    this.body.introduce(scene.numbers);
    this.prediction.close();
    this.sliders(scene);
    this.state = null;
    this.status(scene.status);
    this.camera.look(scene.view);
    this.fit();
    if (scene.gallery && !this.opened) this.gallery.open();
    else if (!scene.gallery) this.gallery.close();
    this.opened = true;
    if (this.still && !scene.status.paused) this.send({ do: "pause", on: true });
  }

  embody({ world, version, bodies }) {
    const made = bodies.map((body) => ({ ...body, path: outline(body) }));
    if (world === 1) this.ghost = { bodies: made, frame: null, version };
    else {
      this.version = version;
      this.bodies = made;
      this.frame = null;
      if (!bodies.some((body) => body.name === this.chosen)) this.choose(null);
    }
  }

  /** The scene's own parameters first, then what every scene has. */
  sliders(scene) {
    this.controls = new Map();
    const own = scene.parameters.map((p) => this.slider({ ...p, notch: (p.high - p.low) / 200 }, scene.status.parameters[p.name], "parameter"));
    const all = scene.knobs.map((knob) => this.slider(knob, scene.status.settings[knob.name] ?? null, "set"));
    if (own.length && all.length) own.at(-1).classList.add("last");
    this.knobs.replaceChildren(...own, ...all);
  }

  slider(knob, now, does) {
    const id = `knob-${knob.name}`;
    const key = `${does} ${knob.name}`;
    const shown = h("span", { class: "value" });
    const label = h("label", { for: id }, spoken(knob.name));
    const make = (input) => {
      this.controls.set(key, { knob, input, shown, does, values: input.values });
      return h("div", { class: "knob", title: knob.meaning }, label, input, shown);
    };
    if (knob.low === 0 && knob.high === 1 && (knob.whole || knob.name === "backwards")) {
      const input = h("input", { type: "checkbox", id });
      input.addEventListener("change", () => this.send({ do: does, key: knob.name, value: Number(input.checked) }));
      return make(input);
    }
    const values = does === "set" ? stops(knob, now) : even(knob, now);
    const input = h("input", { type: "range", id, min: "0", max: String(values.length - 1), step: "1" });
    input.values = values;
    const commit = () => {
      this.later(key, { do: does, key: knob.name, value: values[input.value] });
      this.controls.get(key).sent = { value: values[input.value], at: performance.now() };
      this.show(key, values[input.value]);
    };
    input.addEventListener("input", commit);
    // A slider at its end that shows what bodies have of their own moves no further, and yet it was meant.
    const meant = ({ key: pressed }) => {
      if (input.classList.contains("unset") && (!pressed || /^(Arrow|Home|End)/.test(pressed))) commit();
    };
    for (const kind of ["click", "keyup"]) input.addEventListener(kind, meant);
    return make(input);
  }

  show(key, value) {
    const control = this.controls.get(key);
    if (!control) return;
    const { knob, values, input, shown, sent } = control;
    if (!values) {
      input.checked = Boolean(value);
      return;
    }
    const unset = value === null;
    const usual = unset ? this.usual(knob.name) : value;
    // A thumb that a hand moves is ahead of the world; what undo does to it, it follows.
    if (value === sent?.value && !this.waiting.has(key)) control.sent = null;
    if (unset || !sent || performance.now() - sent.at > 1000) input.value = String(nearest(values, usual));
    const pair = knob.name === "restitution" || knob.name === "friction" ? `, two: ${plain(Number((value ** 2).toPrecision(2)))}` : "";
    const text = unset ? "as it is" : amount(value, knob.unit) + pair;
    shown.textContent = text;
    input.classList.toggle("unset", unset);
    input.setAttribute("aria-valuetext", unset ? `each body has its own, mostly ${plain(usual)}` : text);
  }

  /** The value that most bodies have, of what each has of its own. */
  usual(key) {
    const own = this.bodies.filter((body) => !body.fixed).map((body) => body[key]);
    return own.sort((a, b) => a - b)[Math.floor(own.length / 2)] ?? 0.5;
  }

  status(status) {
    const before = this.state;
    this.state = status;
    for (const [key, { knob, does }] of this.controls) {
      this.show(key, (does === "set" ? status.settings : status.parameters)[knob.name] ?? (knob.name === "walls" ? 0 : null));
    }
    this.run.textContent = status.paused ? "Run" : "Pause";
    if (document.activeElement !== this.speed) this.speed.value = String(nearest(this.speeds, status.speed));
    this.speedShown.textContent = `${plain(status.speed)}×`;
    this.speed.setAttribute("aria-valuetext", `${plain(status.speed)} times real time`);
    this.prediction.status(status, before);
    for (const [button, what, why] of [[this.undo, "Undo", status.undo], [this.redo, "Redo", status.redo]]) {
      button.disabled = !why;
      button.title = why ? `${what}: ${why}` : `Nothing to ${what.toLowerCase()}`;
    }
    this.ghostly.checked = Boolean(status.ghost);
    this.ghostly.disabled = status.ghost === null;
    if (!status.ghost) this.ghost.frame = null;
    const past = status.at !== null;
    if (!past || !status.paused) this.sought = null;
    this.goOn.disabled = this.now.disabled = !past;
    this.root.classList.toggle("past", past);
    const { working } = status;
    this.work.hidden = !working;
    if (working) {
      this.work.firstChild.value = working.share;
      this.work.children[1].textContent = working.says;
    }
    if (!before) return;
    if (before.paused !== status.paused) this.tell(status.paused ? `Paused at ${short(this.frame?.t ?? 0)} seconds.` : "Running.");
    if (past !== (before.at !== null)) this.tell(past ? `Looking at ${short(status.at)} seconds.` : "Now.");
  }

  // -- words for screen readers ------------------------------------------------------------------------

  happened({ events, anew }) {
    if (anew) {
      this.list.replaceChildren();
      this.painter.flashes = [];
      this.unsaid = [];
      if (this.trace) this.send({ do: "trace", name: this.trace.name });
    }
    this.addLines(events);
    if (!this.still && !anew) this.painter.flash(events);
    if (!anew) this.unsaid.push(...events.map((event) => event.text));
  }

  addLines(events) {
    const lines = events.map((event) => {
      const [time, ...rest] = event.text.split(": ");
      const parts = rest.length ? [h("time", {}, time), rest.join(": ")] : [event.text];
      return h("li", { class: event.kind }, ...parts);
    });
    this.list.prepend(...lines.reverse());
    while (this.list.children.length > KEPT) this.list.lastChild.remove();
  }

  /** A sentence that matters now; one that stays if the connection is gone. */
  say(text, stays = false) {
    this.banner.textContent = text;
    this.banner.hidden = !text;
    clearTimeout(this.hush);
    if (text && !stays) this.hush = setTimeout(() => this.say(""), Math.max(4000, 60 * text.length));
  }

  /** A sentence for ears alone. */
  tell(text) {
    this.live.textContent = text;
    this.spoke = performance.now();
  }

  /** Events for ears: the latest, and how many there were, but never a flood. */
  speak() {
    if (!this.unsaid.length || performance.now() - this.spoke < CALM) return;
    const more = this.unsaid.length - 1;
    this.tell(this.unsaid.at(-1) + (more ? ` And ${more} more before it.` : ""));
    this.unsaid = [];
  }

  // -- what is asked for --------------------------------------------------------------------------------

  /** Requests of which only the latest counts go out once a frame. */
  later(key, message) {
    this.waiting.set(key, message);
  }

  flush() {
    for (const message of this.waiting.values()) this.send(message);
    this.waiting.clear();
  }

  toggle() {
    this.send({ do: "pause", on: !this.state?.paused });
  }

  back() {
    const t = this.frame.t - 1 / 60;
    this.send(this.state.at === null ? { do: "look", t } : { do: "step", kind: "back" });
  }

  lineKey(event) {
    const step = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -10, PageUp: 10 }[event.key];
    if (!step) return;
    event.preventDefault();
    // Keys come faster than frames: each goes on from where the last one went.
    this.sought = Math.max(0, (this.sought ?? this.frame.t) + (step * Number(this.line.max)) / 100);
    this.later("look", { do: "look", t: this.sought });
  }

  zoom(factor) {
    if (factor) this.camera.zoomBy(factor);
    else {
      this.followed = null;
      this.camera.reset();
    }
    this.moved();
  }

  follow() {
    this.followed = this.followed === this.chosen ? null : this.chosen;
    this.tell(this.followed ? `The view follows ${spoken(this.chosen)}.` : "The view stands.");
    this.stale = 0;
    this.changed = true;
  }

  traceBody() {
    const on = this.trace?.name !== this.chosen;
    this.trace = on ? { name: this.chosen, rows: [] } : null;
    if (on) this.send({ do: "trace", name: this.chosen });
    this.tell(on ? `The path of ${spoken(this.chosen)} is drawn.` : "No path is drawn.");
    this.stale = 0;
    this.changed = true;
  }

  choose(name) {
    this.chosen = name;
    this.body.element.open = false;
    if (this.state) this.body.show(); // with the label itself, not a frame later
    this.stale = 0;
    this.changed = true;
  }

  row(i) {
    return rowOf(this.frame, i);
  }

  rowOf(name) {
    const i = this.frame ? this.bodies.findIndex((body) => body.name === name) : -1;
    return i < 0 ? null : this.row(i);
  }

  /** Metres of an arrow stand for this many m/s: the fastest body's fills a good part of the view. */
  get gain() {
    if (this.pointer) return this.pointer.gain;
    const [left, , right] = this.scene.view;
    let fastest = 0;
    this.bodies.forEach((body, i) => {
      const [, , , vx, vy] = this.row(i);
      if (!body.fixed) fastest = Math.max(fastest, Math.hypot(vx, vy));
    });
    return round(Math.max(2, (2 * fastest) / (right - left)));
  }

  // -- drawing ------------------------------------------------------------------------------------

  fit() {
    const { canvas } = this;
    if (!this.scene || !canvas.clientWidth || !canvas.clientHeight) return;
    this.camera.fit();
    canvas.width = Math.round(canvas.clientWidth * this.camera.dense);
    canvas.height = Math.round(canvas.clientHeight * this.camera.dense);
    this.stale = 0;
    this.moved();
    this.draw(); // at once: a canvas that changed its size is empty
  }

  /** The camera moved. */
  moved() {
    const gap = round(50 / this.camera.scale);
    this.ruler.firstChild.style.width = `${gap * this.camera.scale}px`;
    this.ruler.lastChild.textContent = `${plain(gap)} m`;
    this.changed = true;
  }

  draw() {
    if (!this.frame || !this.scene || !(this.changed || this.painter.flashes.length)) return this.speak();
    this.changed = false;
    const followed = this.followed && this.rowOf(this.followed);
    if (followed) this.camera.follow(followed[0], followed[1]);
    this.painter.draw();
    this.numbersShown();
    return this.speak();
  }

  /** Numbers and plots: fast enough for eyes, at a quarter of the frames. */
  numbersShown() {
    const now = performance.now();
    if (this.stale && now - this.stale < 60) {
      this.changed = true;
      return;
    }
    this.stale = now;
    const { t, pace, n } = this.frame;
    const digits = this.span < 1 ? 3 : 2;
    this.clock.textContent = `${t.toFixed(digits)} s`;
    const slow = !this.state?.paused && pace < 0.8;
    this.lag.textContent = slow ? `This machine manages ${Math.round(100 * pace)} % of the speed` : "";
    this.body.show();
    const end = this.state.now ?? t;
    this.line.max = String(end);
    if (document.activeElement !== this.line || this.state.at === null || !this.waiting.has("look")) this.line.value = String(t);
    this.line.setAttribute("aria-valuetext", `${t.toFixed(digits)} s of ${end.toFixed(digits)} s`);
    this.lineShown.textContent = this.state.at === null ? "now" : `${t.toFixed(digits)} of ${end.toFixed(digits)} s`;
    this.lineShown.style.minWidth = `${2 * end.toFixed(digits).length + 6}ch`; // the line stays as long as it is
    this.tag.textContent = this.gone() || (this.scene.above ? "Seen from above" : "");
    this.ticks(end);
    const colour = (name) => this.colour(name);
    const at = this.state.at === null ? null : t;
    const shown = [t, ...n.subarray(11, 19)];
    this.energy.draw(this.past, this.span, colour, shown, at);
    this.momentum.draw(this.past, this.span, colour, shown, at);
    this.energy.sum.textContent = `start + given = ${short(n[22])} J`;
  }

  /** Where everything that moves has left the picture: how to see it again. */
  gone() {
    const [left, bottom, right, top] = this.scene.view;
    const [x, y] = this.camera.centre;
    const [wide, high] = this.camera.middle.map((half) => half / this.camera.scale);
    let inScene = false;
    for (const [i, body] of this.bodies.entries()) {
      if (body.fixed) continue;
      const [bx, by] = this.row(i);
      const size = body.radius + Math.max(0, ...body.outline.map((p) => Math.hypot(...p)));
      const within = (l, b, r, t) => bx > l - size && bx < r + size && by > b - size && by < t + size;
      if (within(x - wide, y - high, x + wide, y + high)) return "";
      inScene ||= within(left, bottom, right, top);
    }
    if (!this.bodies.some((body) => !body.fixed)) return "";
    return inScene ? "Nothing moves in this part: ⤢ shows all of it." : "Everything has left the picture. Reset begins again.";
  }

  /** A tick for each contact on the time line. */
  ticks(end) {
    const { marked } = this;
    const [width, height] = [marked.clientWidth, marked.clientHeight];
    if (marked.width !== width) [marked.width, marked.height] = [width, height];
    const c = marked.getContext("2d");
    c.clearRect(0, 0, width, height);
    c.fillStyle = this.colour("--contacts");
    for (const t of this.marks) if (t <= end) c.fillRect(8 + (t / (end || 1)) * (width - 16) - 0.5, 0, 1, height);
  }
}

function rowsOf(n, from, rows, columns) {
  return Array.from({ length: rows }, (_, i) => [...n.subarray(from + i * columns, from + (i + 1) * columns)]);
}

/** Values of a parameter, evenly spaced, with the present one among them. */
function even({ low, high }, now) {
  const gap = round((high - low) / 200);
  const values = [now, low, high];
  for (let i = Math.ceil(low / gap); i * gap <= high; i++) values.push(Number((i * gap).toPrecision(10)));
  return [...new Set(values)].sort((a, b) => a - b);
}
