// A world as a page shows it. `mount(element, { send, named })` builds everything inside one element; `send` takes
// one request as an object, `receive` what the world answers: JSON text (or an object), and float32 frames; `named`
// is told the scene's title.
// Nothing is fetched, and nothing outside the element is touched, so a notebook can use this file as it is.

const HEAD = 21; // numbers in front of the bodies of a frame
const PER_BODY = 5; // x, y, angle, vx, vy
const FLASH = 350; // ms that a contact glows
const CALM = 2500; // ms between sentences that are spoken
const KEPT = 60; // sentences in the list
const ENERGY = [
  ["kinetic", "of motion", "--kinetic"],
  ["potential", "of height", "--potential"],
  ["contacts", "lost in contacts", "--contacts"],
  ["friction", "lost to friction", "--friction"],
  ["rods", "lost in rods", "--rods"],
  ["residual", "solver's error", "--residual"],
];
const MOMENTUM = [
  ["px", "to the right", "--kinetic"],
  ["py", "upwards", "--contacts"],
];
const COLUMNS = ["t", ...ENERGY.map((s) => s[0]), ...MOMENTUM.map((s) => s[0])];
const KEYS = [
  ["Space", "run, pause"],
  ["S", "one step"],
  ["R", "back to the start"],
  ["N, Shift+N", "next, previous body"],
  ["Arrows", "push it; Shift for more"],
  ["B, X", "a new ball, box"],
  ["Esc", "choose no body"],
];

export function mount(element, { send, named = () => {} }) {
  const view = new View(element, send, named);
  return {
    receive: (data) => view.receive(data),
    lost: (text) => view.say(text, true),
    destroy: () => view.destroy(),
  };
}

// -- small things ---------------------------------------------------------------------------------

function h(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith("on")) made.addEventListener(key.slice(2), value);
    else if (value === true) made.setAttribute(key, "");
    else if (value !== false && value !== null) made.setAttribute(key, value);
  }
  made.append(...children.filter((child) => child !== null));
  return made;
}

/** Three digits that count, without the tails of floats. */
function short(value, scale = 0) {
  if (value === null || !Number.isFinite(value)) return "–";
  if (Math.abs(value) <= 2e-6 * scale || value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e5 || size < 1e-3) return value.toExponential(1).replaceAll("-", "−");
  const text = size >= 100 ? value.toFixed(0) : size >= 10 ? value.toFixed(1) : value.toFixed(size >= 1 ? 2 : 3);
  return text.replaceAll("-", "−");
}

/** A round number in few letters. */
function tick(value) {
  const text = String(Number(value.toPrecision(2)));
  return (text.length > 5 ? value.toExponential(0) : text).replaceAll("-", "−");
}

/** A number as it was meant: up to six digits, none that say nothing. */
const plain = (value) => (value === null ? "did not happen" : String(Number(value.toPrecision(6))).replaceAll("-", "−"));
const spoken = (name) => name.replaceAll("-", " ");
const amount = (value, of) => {
  const small = of === "s" && value < 0.1;
  return plain(Number((small ? 1000 * value : value).toPrecision(3))) + unit(small ? "ms" : of);
};
const unit = (text) => (text === "1" || !text ? "" : ` ${text}`);

/** The values a slider can take: fine near where worlds usually are, coarse far out. */
function stops(knob, current) {
  const values = [];
  if (knob.times) {
    for (let v = current; v >= knob.low * 0.999; v /= knob.notch) values.unshift(v);
    for (let v = current * knob.notch; v <= knob.high * 1.001; v *= knob.notch) values.push(v);
  } else {
    const far = knob.low === 0 && (knob.high - knob.low) / knob.notch >= 100;
    const count = far ? 90 : Math.round((knob.high - knob.low) / knob.notch);
    for (let i = 0; i <= count; i++) {
      const part = far ? (i / count) ** 3 : i / count;
      values.push(knob.low + Math.round(((knob.high - knob.low) * part) / knob.notch) * knob.notch);
    }
    if (current !== null) values.push(current);
  }
  const inside = values.map((v) => Math.min(knob.high, Math.max(knob.low, knob.whole ? Math.round(v) : v)));
  return [...new Set(inside.map((v) => Number(v.toPrecision(12))))].sort((a, b) => a - b);
}

function nearest(values, wanted) {
  let best = 0;
  values.forEach((value, i) => {
    if (Math.abs(value - wanted) < Math.abs(values[best] - wanted)) best = i;
  });
  return best;
}

/** The next round number from this size up: 1, 2 or 5 times a power of ten. */
function round(size) {
  const power = 10 ** Math.floor(Math.log10(size));
  return power * [1, 2, 5, 10].find((step) => step * power >= size * 0.999);
}

// -- plots ----------------------------------------------------------------------------------------

/** The past as columns; as many samples as fit, the oldest forgotten first. */
class Past {
  constructor(most = 4096) {
    this.most = most;
    this.clear();
  }
  clear() {
    this.rows = [];
  }
  add(row) {
    const last = this.rows.at(-1);
    if (last && row[0] < last[0] - 1e-6) this.clear();
    else if (last && row[0] <= last[0]) this.rows.pop();
    this.rows.push(row);
    if (this.rows.length > this.most) this.rows = this.rows.slice(this.most / 4);
  }
}

class Plot {
  constructor(title, unitText, series) {
    this.series = series.map(([key, label, colour]) => ({ at: COLUMNS.indexOf(key), label, colour }));
    this.canvas = h("canvas", { "aria-hidden": "true" });
    this.values = this.series.map(() => h("dd"));
    const legend = this.series.map((s, i) =>
      h("div", {}, h("dt", { class: `key ${s.colour.slice(2)}` }, s.label), this.values[i]),
    );
    this.element = h(
      "section",
      { class: "plot" },
      h("h2", {}, title, h("small", {}, ` ${unitText}`)),
      this.canvas,
      h("dl", {}, ...legend),
    );
  }

  draw(past, span, colour) {
    const { canvas } = this;
    const width = canvas.clientWidth;
    const height = canvas.clientHeight;
    const dense = Math.min(devicePixelRatio || 1, 2);
    if (canvas.width !== Math.round(width * dense) || canvas.height !== Math.round(height * dense)) {
      canvas.width = Math.round(width * dense);
      canvas.height = Math.round(height * dense);
    }
    const c = canvas.getContext("2d");
    c.setTransform(dense, 0, 0, dense, 0, 0);
    c.clearRect(0, 0, width, height);
    const now = past.rows.at(-1);
    if (!now || !width) return;
    const end = Math.max(span, now[0]);
    const rows = past.rows.filter((row) => row[0] >= end - span);
    let [low, high] = [0, 0];
    for (const row of rows) {
      for (const s of this.series) {
        if (row[s.at] < low) low = row[s.at];
        if (row[s.at] > high) high = row[s.at];
      }
    }
    const scale = Math.max(-low, high);
    // Most scenes have no rods, and most rods take nothing.
    const drawn = this.series.filter((s) => s.colour !== "--rods" || rows.some((row) => row[s.at]));
    this.series.forEach((s, i) => {
      this.values[i].parentElement.hidden = !drawn.includes(s);
      this.values[i].textContent = short(now[s.at], scale);
    });
    if (scale < 1e-12) high = 1;
    const pad = (high - low) * 0.06;
    const left = 34;
    const x = (t) => left + ((t - end + span) / span) * (width - left - 2);
    const y = (v) => height - 4 - ((v - low + pad) / (high - low + 2 * pad)) * (height - 8);
    this.axes(c, { low, high, x, y, width, left, colour });
    for (const s of drawn) this.line(c, rows, s, x, y, colour);
  }

  axes(c, { low, high, y, width, left, colour }) {
    c.font = "11px system-ui, sans-serif";
    c.textAlign = "right";
    c.textBaseline = "middle";
    c.lineWidth = 1;
    const gap = round((high - low) / 3);
    for (let v = Math.ceil(low / gap) * gap; v <= high + gap * 1e-6; v += gap) {
      const zero = Math.abs(v) < gap / 2;
      c.strokeStyle = colour(zero ? "--axis" : "--grid");
      c.beginPath();
      c.moveTo(left, Math.round(y(v)) + 0.5);
      c.lineTo(width, Math.round(y(v)) + 0.5);
      c.stroke();
      c.fillStyle = colour("--quiet");
      c.fillText(zero ? "0" : tick(v), left - 5, y(v));
    }
  }

  line(c, rows, s, x, y, colour) {
    c.strokeStyle = colour(s.colour);
    c.lineWidth = 1.75;
    c.setLineDash(s.colour === "--residual" ? [3, 3] : []);
    c.beginPath();
    const every = Math.ceil(rows.length / 600); // more points than pixels show nothing more
    const last = rows.length - 1;
    c.moveTo(x(rows[0][0]), y(rows[0][s.at]));
    for (let i = every; i < last; i += every) c.lineTo(x(rows[i][0]), y(rows[i][s.at]));
    c.lineTo(x(rows[last][0]), y(rows[last][s.at]));
    c.stroke();
    c.setLineDash([]);
  }
}

// -- geometry -------------------------------------------------------------------------------------

function outline(body) {
  const path = new Path2D();
  if (body.shape === "circle") path.arc(0, 0, body.radius, 0, 2 * Math.PI);
  else {
    body.outline.forEach(([px, py], i) => (i ? path.lineTo(px, py) : path.moveTo(px, py)));
    if (body.shape === "polygon") path.closePath();
  }
  return path;
}

/** How far a point in the body's frame is from its surface; 0 inside. */
function distance(body, px, py) {
  if (body.shape === "circle") return Math.max(0, Math.hypot(px, py) - body.radius);
  const points = body.outline;
  let inside = body.shape === "polygon";
  let best = Infinity;
  points.forEach(([ax, ay], i) => {
    const [bx, by] = points[(i + 1) % points.length];
    const [dx, dy] = [bx - ax, by - ay];
    if (dx * (py - ay) - dy * (px - ax) < 0) inside = false;
    const along = Math.min(1, Math.max(0, ((px - ax) * dx + (py - ay) * dy) / (dx * dx + dy * dy || 1)));
    best = Math.min(best, Math.hypot(px - ax - along * dx, py - ay - along * dy));
  });
  return inside ? 0 : Math.max(0, best - body.radius);
}

// -- the view -------------------------------------------------------------------------------------

class View {
  constructor(element, send, named) {
    this.named = named;
    this.host = element;
    this.send = send;
    this.bodies = [];
    this.version = null;
    this.frame = null;
    this.past = new Past();
    this.flashes = [];
    this.chosen = null; // name of the body that keys push
    this.pointer = null; // what a pointer is doing
    this.waiting = new Map(); // requests of which only the latest counts
    this.count = 0;
    this.spoke = 0;
    this.unsaid = [];
    this.still = matchMedia("(prefers-reduced-motion: reduce)").matches;
    this.dark = matchMedia("(prefers-color-scheme: dark)");
    this.onScheme = () => this.repaint();
    this.dark.addEventListener("change", this.onScheme);
    this.build();
    this.observer = new ResizeObserver(() => this.fit());
    this.observer.observe(this.canvas);
    this.loop = () => {
      this.request = requestAnimationFrame(this.loop);
      this.flush();
      this.draw();
    };
    this.loop();
  }

  destroy() {
    cancelAnimationFrame(this.request);
    this.observer.disconnect();
    this.dark.removeEventListener("change", this.onScheme);
    this.root.remove();
  }

  // -- building -----------------------------------------------------------------------------------

  build() {
    const button = (label, act, more = {}) => h("button", { type: "button", onclick: act, ...more }, label);
    this.title = h("h1");
    this.teaches = h("p", { class: "teaches" });
    // A screen reader would read an output element aloud at every change.
    this.clock = h("span", { class: "clock", role: "timer", "aria-label": "simulated time" });
    this.canvas = h("canvas", { class: "world", tabindex: "0", role: "application" });
    this.canvas.setAttribute("aria-label", "The world. N chooses a body, arrow keys push it, Space runs and pauses.");
    this.tag = h("p", { class: "tag" });
    this.picked = h("p", { class: "picked", hidden: true });
    this.lag = h("p", { class: "lag" });
    this.ruler = h("p", { class: "ruler" }, h("i"), h("span"));
    this.banner = h("p", { class: "banner", role: "alert", hidden: true });
    this.card = h("section", { class: "card", "aria-label": "Prediction", hidden: true });
    this.run = button("Run", () => this.toggle(), { class: "main" });
    this.arrows = h("input", { type: "checkbox", onchange: () => this.draw() });
    this.speed = h("input", { type: "range", min: "0", step: "1", id: "speed" });
    this.speedShown = h("span", { class: "value" });
    this.speed.addEventListener("input", () => this.later("speed", { do: "speed", value: this.speeds[this.speed.value] }));
    this.speeds = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 4];
    this.knobs = h("div", { class: "knobs" });
    this.energy = new Plot("Energy", "in J", ENERGY);
    this.momentum = new Plot("Momentum", "in kg m/s", MOMENTUM);
    this.list = h("ol", { tabindex: "0", "aria-label": "Events, newest first" });
    this.note = h("p");
    this.after = h("p");
    this.live = h("p", { class: "unseen", role: "status", "aria-live": "polite" });
    const bar = h(
      "div",
      { class: "bar", role: "group", "aria-label": "Time and bodies" },
      this.run,
      button("Step", () => this.send({ do: "step" })),
      button("Reset", () => this.send({ do: "reset" })),
      h("span", { class: "gap" }),
      button("+ Ball", () => this.spawn("circle")),
      button("+ Box", () => this.spawn("box")),
      h("label", { class: "check" }, this.arrows, "Arrows"),
      h("label", { class: "speed", for: "speed" }, h("span", {}, "Speed"), this.speed, this.speedShown),
    );
    const theme = button("◐", () => this.scheme(), { class: "round", "aria-label": "Dark or light", title: "Dark or light" });
    const keys = KEYS.map(([key, does]) => h("div", {}, h("dt", {}, key), h("dd", {}, does)));
    const panel = h(
      "aside",
      { class: "panel", "aria-label": "Numbers" },
      h("section", {}, h("h2", {}, "Settings"), this.knobs),
      this.energy.element,
      this.momentum.element,
      h("section", { class: "events" }, h("h2", {}, "What happened"), this.list),
      h("details", {}, h("summary", {}, "About this scene"), this.note, this.after),
      h("details", { class: "keys" }, h("summary", {}, "Keys, while the world has the focus"), h("dl", {}, ...keys)),
    );
    this.root = h(
      "div",
      { class: "sandbox" },
      h("header", { class: "top" }, this.title, this.clock, theme, this.teaches),
      h("div", { class: "stage" }, this.canvas, this.tag, this.picked, this.lag, this.ruler, this.banner),
      this.card,
      bar,
      panel,
      this.live,
    );
    this.listen();
    this.host.replaceChildren(this.root);
  }

  listen() {
    const { canvas } = this;
    canvas.addEventListener("pointerdown", (event) => this.down(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    canvas.addEventListener("pointerup", (event) => this.up(event, true));
    canvas.addEventListener("pointercancel", (event) => this.up(event, false));
    canvas.addEventListener("dblclick", (event) => {
      const [x, y] = this.place(event);
      if (!this.pick(x, y, this.reach(event))) this.send({ do: "spawn", shape: event.shiftKey ? "box" : "circle", x, y });
    });
    canvas.addEventListener("keydown", (event) => this.key(event));
  }

  scheme() {
    const dark = this.root.dataset.theme ? this.root.dataset.theme === "dark" : this.dark.matches;
    this.root.dataset.theme = dark ? "light" : "dark";
    this.repaint();
  }

  repaint() {
    this.colours = null;
    this.stale = 0;
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
    const numbers = ArrayBuffer.isView(data)
      ? new Float32Array(data.buffer.slice(data.byteOffset, data.byteOffset + data.byteLength))
      : new Float32Array(data);
    if (numbers[0] === 3) {
      const [, , rows, columns] = numbers;
      this.past.clear();
      for (let i = 0; i < rows; i++) this.past.add(numbers.slice(4 + i * columns, 4 + (i + 1) * columns));
    } else if (numbers[0] === 1 && numbers[1] === this.version) {
      const [, , t, pace, count, joints] = numbers;
      if (count !== this.bodies.length) return;
      this.frame = { t, pace, count, joints, n: numbers };
      this.past.add([t, ...numbers.slice(11, 19)]);
      this.changed = true;
    }
  }

  words(message) {
    if (message.type === "scene") this.introduce(message);
    else if (message.type === "bodies") this.embody(message);
    else if (message.type === "status") this.status(message);
    else if (message.type === "events") this.tell(message);
    else if (message.type === "error") this.say(message.message);
  }

  introduce(scene) {
    this.scene = scene;
    this.say("");
    this.title.textContent = scene.title;
    this.named(scene.title);
    this.teaches.textContent = scene.teaches;
    this.note.textContent = scene.note;
    this.after.replaceChildren(h("strong", {}, "Think: "), scene.after);
    this.tag.textContent = scene.above ? "Seen from above" : "";
    const [left, bottom, right, top] = scene.view;
    this.root.style.setProperty("--shape", `${right - left} / ${top - bottom}`);
    this.span = Math.min(Math.max(scene.duration, 0.01), 10);
    this.list.replaceChildren();
    this.addLines(scene.events);
    if (!this.speeds.includes(scene.status.speed)) {
      this.speeds = [...this.speeds, scene.status.speed].sort((a, b) => a - b);
    }
    this.speed.max = String(this.speeds.length - 1);
    this.sliders(scene);
    this.state = null;
    this.status(scene.status);
    this.fit();
    if (this.still && !scene.status.question && !scene.status.paused) this.send({ do: "pause", on: true });
  }

  embody({ version, bodies }) {
    this.version = version;
    this.bodies = bodies.map((body) => ({ ...body, path: outline(body) }));
    this.frame = null;
    if (!bodies.some((body) => body.name === this.chosen)) this.choose(null);
  }

  sliders(scene) {
    this.controls = new Map();
    const rows = scene.knobs.map((knob) => {
      const now = scene.status.settings[knob.name] ?? null;
      const values = stops(knob, now);
      const id = `knob-${knob.name}`;
      const input = h("input", { type: "range", id, min: "0", max: String(values.length - 1), step: "1" });
      const shown = h("span", { class: "value" });
      input.addEventListener("input", () => {
        const value = values[input.value];
        this.show(knob.name, value);
        this.later(knob.name, { do: "set", key: knob.name, value });
      });
      this.controls.set(knob.name, { knob, values, input, shown });
      return h("div", { class: "knob", title: knob.meaning }, h("label", { for: id }, spoken(knob.name)), input, shown);
    });
    this.knobs.replaceChildren(...rows);
  }

  show(name, value) {
    const control = this.controls.get(name);
    if (!control) return;
    const { knob, values, input, shown } = control;
    const unset = value === null;
    if (!unset && document.activeElement !== input) input.value = String(nearest(values, value));
    if (unset) input.value = String(nearest(values, 0.5));
    const text = unset ? "as it is" : amount(value, knob.unit);
    shown.textContent = text;
    input.classList.toggle("unset", unset);
    input.setAttribute("aria-valuetext", unset ? "each body has its own" : text);
  }

  status(status) {
    const before = this.state;
    this.state = status;
    for (const name of this.controls.keys()) this.show(name, status.settings[name] ?? null);
    this.run.textContent = status.paused ? "Run" : "Pause";
    if (document.activeElement !== this.speed) this.speed.value = String(nearest(this.speeds, status.speed));
    this.speedShown.textContent = `${plain(status.speed)}×`;
    this.speed.setAttribute("aria-valuetext", `${plain(status.speed)} times real time`);
    if (!before || before.stage !== status.stage || before.guess !== status.guess) this.predict(status);
    else if (before.question !== status.question) {
      const asked = this.card.querySelector(".question"); // beside a field that the student may be typing in
      if (asked) asked.textContent = status.question;
    }
    this.changed = true;
  }

  // -- words for screen readers ------------------------------------------------------------------------

  tell({ events, anew }) {
    if (anew) {
      this.list.replaceChildren();
      this.flashes = [];
      this.unsaid = [];
    }
    this.addLines(events);
    const now = performance.now();
    if (!this.still) {
      for (const event of events) if (event.x !== undefined) this.flashes.push({ ...event, at: now });
      this.flashes = this.flashes.slice(-24);
    }
    this.unsaid.push(...events.map((event) => event.text));
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
    if (text && !stays) this.hush = setTimeout(() => this.say(""), 4000);
  }

  /** Events for ears: the latest, and how many there were, but never a flood. */
  speak() {
    const now = performance.now();
    if (!this.unsaid.length || now - this.spoke < CALM) return;
    const more = this.unsaid.length - 1;
    this.live.textContent = this.unsaid.at(-1) + (more ? ` And ${more} more before it.` : "");
    this.unsaid = [];
    this.spoke = now;
  }

  // -- predict, run, compare ----------------------------------------------------------------------

  predict({ stage, guess, comparison }) {
    const { scene } = this;
    const hadFocus = this.card.contains(document.activeElement);
    const inside = { ask: () => this.ask(), touched: () => this.touched(), done: () => this.compare(comparison) }[stage];
    this.card.replaceChildren(...(inside ? inside() : []));
    this.card.hidden = !inside;
    if (stage === "run" && guess !== null) {
      this.tag.textContent = `Your guess: ${plain(guess)}${unit(scene.unit)}; compared at ${plain(scene.duration)} s`;
    } else this.tag.textContent = scene.above ? "Seen from above" : "";
    if (hadFocus && !inside) this.run.focus();
    if (stage === "done" && comparison) this.live.textContent = comparison.verdict;
  }

  ask() {
    const { scene } = this;
    const field = h("input", { id: "guess", inputmode: "decimal", autocomplete: "off", size: "8" });
    const wrong = h("span", { class: "wrong", role: "alert" });
    const answer = (event) => {
      event.preventDefault();
      const text = field.value.trim().replace(",", ".").replace("−", "-");
      const value = Number(text);
      if (!text || !Number.isFinite(value)) {
        wrong.textContent = "A number, please.";
        field.focus();
      } else this.send({ do: "guess", value });
    };
    return [
      h("p", { class: "question" }, this.state.question),
      h(
        "form",
        { onsubmit: answer },
        h("label", { for: "guess" }, "Your guess"),
        field,
        h("span", { class: "unit" }, scene.unit === "1" ? "" : scene.unit),
        h("button", { class: "main" }, "Run and compare"),
        h("button", { type: "button", onclick: () => this.send({ do: "guess", value: null }) }, "Just run"),
        wrong,
      ),
    ];
  }

  touched() {
    return [h("p", { class: "aside" }, "You changed this run, so there is nothing to compare with. Reset starts a new run.")];
  }

  compare(c) {
    const cell = (name, value, kind) =>
      h("div", { class: kind }, h("dt", {}, name), h("dd", {}, plain(value), h("small", {}, value === null ? "" : unit(c.unit))));
    const again = () => {
      this.send({ do: "reset" });
      this.send({ do: "pause", on: false });
    };
    const answers = [cell("Theory", c.theory, ""), cell("Simulation", c.simulation, c.agree ? "" : "off")];
    if (c.guess !== null) answers.unshift(cell("Your guess", c.guess, c.guess_right ? "right" : "off"));
    return [
      h("dl", { class: "answers" }, ...answers),
      h("p", { class: "verdict" }, c.verdict),
      h("p", { class: "why" }, c.why),
      h("p", { class: "why" }, h("strong", {}, "Think: "), this.scene.after),
      h(
        "div",
        { class: "actions" },
        h("button", { type: "button", class: "main", onclick: again }, "Run again"),
        h("button", { type: "button", onclick: () => this.dismiss() }, "Keep playing"),
      ),
    ];
  }

  dismiss() {
    this.card.hidden = true;
    this.send({ do: "pause", on: false });
    this.run.focus();
  }

  // -- hands --------------------------------------------------------------------------------------

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

  spawn(shape) {
    const [left, bottom, right, top] = this.scene.view;
    // One beside the other, high up, so that they do not start inside each other.
    const part = (0.5 + 0.618 * this.count++) % 1;
    this.send({ do: "spawn", shape, x: left + (right - left) * (0.15 + 0.7 * part), y: bottom + (top - bottom) * 0.85 });
  }

  place(event) {
    const box = this.canvas.getBoundingClientRect();
    return [
      (event.clientX - box.left - this.middle[0]) / this.scale + this.centre[0],
      this.centre[1] - (event.clientY - box.top - this.middle[1]) / this.scale,
    ];
  }

  reach(event) {
    return (event.pointerType === "mouse" ? 10 : 26) / this.scale;
  }

  /** The movable body nearest to a place, if it is near enough. */
  pick(x, y, reach) {
    if (!this.frame) return null;
    let best = null;
    let least = reach;
    this.bodies.forEach((body, i) => {
      if (body.fixed) return;
      const [bx, by, angle] = this.row(i);
      const [c, s] = [Math.cos(angle), Math.sin(angle)];
      const far = distance(body, c * (x - bx) + s * (y - by), -s * (x - bx) + c * (y - by));
      if (far <= least) [best, least] = [body.name, far];
    });
    return best;
  }

  row(i) {
    const at = HEAD + i * PER_BODY;
    return this.frame.n.subarray(at, at + PER_BODY);
  }

  rowOf(name) {
    const i = this.frame ? this.bodies.findIndex((body) => body.name === name) : -1;
    return i < 0 ? null : this.row(i);
  }

  /** Metres of an arrow stand for this many m/s: the fastest body's fills a good part of the view. */
  get gain() {
    if (this.pointer?.gain) return this.pointer.gain;
    const [left, , right] = this.scene.view;
    let fastest = 0;
    this.bodies.forEach((body, i) => {
      const [, , , vx, vy] = this.row(i);
      if (!body.fixed) fastest = Math.max(fastest, Math.hypot(vx, vy));
    });
    return round(Math.max(2, (2 * fastest) / (right - left)));
  }

  down(event) {
    if (!this.frame || this.pointer || event.button !== 0) return;
    const [x, y] = this.place(event);
    const reach = this.reach(event);
    const name = this.pick(x, y, reach);
    this.choose(name);
    if (!name) return;
    event.preventDefault();
    this.canvas.focus({ preventScroll: true });
    this.canvas.setPointerCapture(event.pointerId);
    this.pointer = { id: event.pointerId, name, x, y, from: [event.clientX, event.clientY] };
    if (this.state.paused) this.pointer.gain = this.gain;
    else this.send({ do: "grab", x, y, reach });
  }

  move(event) {
    const pointer = this.pointer;
    if (!pointer || pointer.id !== event.pointerId) {
      if (this.frame && event.pointerType === "mouse") {
        this.canvas.classList.toggle("over", this.pick(...this.place(event), this.reach(event)) !== null);
      }
      return;
    }
    [pointer.x, pointer.y] = this.place(event);
    pointer.moved ||= Math.hypot(event.clientX - pointer.from[0], event.clientY - pointer.from[1]) > 6;
    if (!pointer.gain) this.later("drag", { do: "drag", x: pointer.x, y: pointer.y });
    this.changed = true;
  }

  up(event, meant) {
    const pointer = this.pointer;
    if (!pointer || pointer.id !== event.pointerId) return;
    if (pointer.gain) {
      const row = this.rowOf(pointer.name);
      if (meant && pointer.moved && row) {
        const [vx, vy] = [(pointer.x - row[0]) * pointer.gain, (pointer.y - row[1]) * pointer.gain];
        this.send({ do: "push", name: pointer.name, vx: vx - row[3], vy: vy - row[4] });
      }
    } else {
      this.flush();
      this.send({ do: "release" });
    }
    this.pointer = null;
    this.changed = true;
  }

  choose(name) {
    this.chosen = name;
    this.pickedShown(); // with the label itself, not a frame later
    this.picked.hidden = !name;
    this.stale = 0;
    this.changed = true;
  }

  pickedShown() {
    const row = this.chosen && this.rowOf(this.chosen);
    if (!row) return;
    const body = this.bodies.find((b) => b.name === this.chosen);
    const mass = body.mass ? `, ${plain(Number(body.mass.toPrecision(3)))} kg` : "";
    this.picked.textContent = `${spoken(this.chosen)}${mass}: ${short(Math.hypot(row[3], row[4]))} m/s`;
  }

  key(event) {
    if (event.ctrlKey || event.altKey || event.metaKey || !this.frame) return;
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    const act = {
      " ": () => this.toggle(),
      s: () => this.send({ do: "step" }),
      r: () => this.send({ do: "reset" }),
      n: () => this.next(event.shiftKey ? -1 : 1),
      b: () => this.spawn("circle"),
      x: () => this.spawn("box"),
      escape: () => this.choose(null),
    }[event.key.toLowerCase()];
    if (step) this.push(...step, event.shiftKey ? 4 : 1);
    else if (act) act();
    else return;
    event.preventDefault();
  }

  next(way) {
    const names = this.bodies.filter((body) => !body.fixed).map((body) => body.name);
    if (!names.length) return;
    const at = names.indexOf(this.chosen);
    const name = names[at < 0 ? (way > 0 ? 0 : names.length - 1) : (at + way + names.length) % names.length];
    this.choose(name);
    const [x, y, , vx, vy] = this.rowOf(name);
    this.live.textContent = `${spoken(name)}: at x ${short(x)}, y ${short(y)} metres, ${short(Math.hypot(vx, vy))} metres per second.`;
  }

  push(dx, dy, times) {
    if (!this.chosen) this.next(1);
    if (!this.chosen) return;
    const [, bottom, , top] = this.scene.view;
    const speed = this.gain * (top - bottom) * 0.05 * times;
    this.send({ do: "push", name: this.chosen, vx: dx * speed, vy: dy * speed });
  }

  // -- drawing ------------------------------------------------------------------------------------

  fit() {
    const { canvas } = this;
    if (!this.scene || !canvas.clientWidth || !canvas.clientHeight) return;
    const [left, bottom, right, top] = this.scene.view;
    this.dense = Math.min(devicePixelRatio || 1, 2);
    canvas.width = Math.round(canvas.clientWidth * this.dense);
    canvas.height = Math.round(canvas.clientHeight * this.dense);
    this.scale = Math.min(canvas.clientWidth / (right - left), canvas.clientHeight / (top - bottom));
    this.middle = [canvas.clientWidth / 2, canvas.clientHeight / 2];
    this.centre = [(left + right) / 2, (bottom + top) / 2];
    const gap = round(50 / this.scale);
    this.ruler.firstChild.style.width = `${gap * this.scale}px`;
    this.ruler.lastChild.textContent = `${plain(gap)} m`;
    this.changed = true;
    this.stale = 0;
    this.draw(); // at once: a canvas that changed its size is empty
  }

  draw() {
    const glowing = this.flashes.length > 0;
    if (!this.frame || !this.scene || !(this.changed || glowing)) return this.speak();
    this.changed = false;
    const c = this.canvas.getContext("2d");
    const s = this.scale * this.dense;
    const [ox, oy] = [
      (this.middle[0] - this.centre[0] * this.scale) * this.dense,
      (this.middle[1] + this.centre[1] * this.scale) * this.dense,
    ];
    c.setTransform(1, 0, 0, 1, 0, 0);
    c.clearRect(0, 0, this.canvas.width, this.canvas.height);
    const flat = () => c.setTransform(s, 0, 0, -s, ox, oy);
    flat();
    this.grid(c);
    flat();
    this.drawJoints(c);
    this.bodies.forEach((body, i) => this.drawBody(c, body, this.row(i), s, ox, oy));
    flat();
    this.drawArrows(c);
    this.drawHand(c);
    this.drawFlashes(c);
    this.numbersShown();
    this.speak();
    return undefined;
  }

  get pixel() {
    return 1 / this.scale;
  }

  grid(c) {
    const gap = round(50 / this.scale);
    const [w, t] = [this.middle[0] / this.scale, this.middle[1] / this.scale];
    const [x0, y0] = this.centre;
    c.lineWidth = this.pixel;
    c.strokeStyle = this.colour("--grid");
    c.beginPath();
    for (let x = Math.ceil((x0 - w) / gap) * gap; x <= x0 + w; x += gap) {
      c.moveTo(x, y0 - t);
      c.lineTo(x, y0 + t);
    }
    for (let y = Math.ceil((y0 - t) / gap) * gap; y <= y0 + t; y += gap) {
      c.moveTo(x0 - w, y);
      c.lineTo(x0 + w, y);
    }
    c.stroke();
  }

  text(c, text, x, y, colour = "--quiet") {
    c.save();
    c.translate(x, y);
    c.scale(this.pixel, -this.pixel);
    c.font = "12px system-ui, sans-serif";
    c.textAlign = "center";
    c.textBaseline = "middle";
    c.lineWidth = 3;
    c.lineJoin = "round";
    c.strokeStyle = this.colour("--paper");
    c.strokeText(text, 0, 0);
    c.fillStyle = this.colour(colour);
    c.fillText(text, 0, 0);
    c.restore();
  }

  drawBody(c, body, [x, y, angle], s, ox, oy) {
    const [cos, sin] = [Math.cos(angle) * s, Math.sin(angle) * s];
    c.setTransform(cos, -sin, -sin, -cos, ox + x * s, oy - y * s);
    const chosen = body.name === this.chosen;
    if (body.track) this.wheels(c, body);
    if (body.shape === "segment") {
      c.lineCap = "round";
      c.lineWidth = Math.max(2 * body.radius, 2 * this.pixel);
      c.strokeStyle = body.colour;
      c.stroke(body.path);
    } else {
      c.fillStyle = body.colour;
      c.fill(body.path);
      // Outlines cost five times as much as areas, so only bodies that would be hard to see get one.
      if (this.faint(body)) {
        c.strokeStyle = this.colour("--rim");
        c.lineWidth = this.pixel;
        c.stroke(body.path);
      }
      if (body.shape === "circle" && !body.fixed) {
        const thick = Math.max(1.5 * this.pixel, body.radius * 0.08);
        c.fillStyle = this.faint(body) ? this.colour("--rim") : "rgba(255, 255, 255, 0.75)";
        c.fillRect(body.radius * 0.35, -thick / 2, body.radius * 0.5, thick);
      }
    }
    if (chosen) {
      c.lineWidth = 3 * this.pixel;
      c.strokeStyle = this.colour("--accent");
      c.stroke(body.path);
    }
  }

  /** Whether a body's colour is all but that of the paper. */
  faint(body) {
    const key = `faint ${body.colour}`;
    if (!this.colours || this.colours[key] === undefined) {
      const light = (hex) => [1, 3, 5].reduce((sum, at, i) => sum + [0.21, 0.72, 0.07][i] * parseInt(hex.slice(at, at + 2), 16), 0);
      const far = Math.abs(light(body.colour) - light(this.colour("--paper")));
      this.colours[key] = far < 40;
    }
    return this.colours[key];
  }

  wheels(c, body) {
    const xs = body.outline.map(([px]) => px);
    const [long, wide] = [(Math.max(...xs) - Math.min(...xs)) * 0.4, body.track * 0.18];
    c.fillStyle = this.colour("--ink");
    for (const side of [-1, 1]) c.fillRect(-long / 2, (side * body.track) / 2 - wide / 2 + side * wide * 0.4, long, wide);
    c.strokeStyle = this.colour("--ink");
    c.lineWidth = 2 * this.pixel;
    c.beginPath();
    c.moveTo(Math.max(...xs), 0);
    c.lineTo(Math.max(...xs) + wide * 1.5, 0);
    c.stroke();
  }

  drawJoints(c) {
    const { n, joints, count } = this.frame;
    c.strokeStyle = this.colour("--quiet");
    c.lineWidth = 1.5 * this.pixel;
    c.beginPath();
    for (let i = 0, at = HEAD + count * PER_BODY; i < joints; i++, at += 4) {
      c.moveTo(n[at], n[at + 1]);
      c.lineTo(n[at + 2], n[at + 3]);
    }
    c.stroke();
  }

  arrow(c, x, y, dx, dy, colour) {
    const size = Math.hypot(dx, dy);
    if (size < 4 * this.pixel) return;
    const head = Math.min(9 * this.pixel, size * 0.5);
    const [ux, uy] = [dx / size, dy / size];
    c.strokeStyle = c.fillStyle = this.colour(colour);
    c.lineWidth = 2 * this.pixel;
    c.beginPath();
    c.moveTo(x, y);
    c.lineTo(x + dx - ux * head, y + dy - uy * head);
    c.stroke();
    c.beginPath();
    c.moveTo(x + dx, y + dy);
    c.lineTo(x + dx - ux * head - uy * head * 0.45, y + dy - uy * head + ux * head * 0.45);
    c.lineTo(x + dx - ux * head + uy * head * 0.45, y + dy - uy * head - ux * head * 0.45);
    c.fill();
  }

  drawArrows(c) {
    const aiming = this.pointer?.gain && this.pointer.moved ? this.pointer : null;
    if (this.arrows.checked || this.state?.paused) {
      const { gain } = this;
      this.bodies.forEach((body, i) => {
        if (body.fixed || body.name === aiming?.name) return;
        const [x, y, , vx, vy] = this.row(i);
        this.arrow(c, x, y, vx / gain, vy / gain, "--ink");
      });
    }
    const row = aiming && this.rowOf(aiming.name);
    if (row) {
      const [dx, dy] = [aiming.x - row[0], aiming.y - row[1]];
      this.arrow(c, row[0], row[1], dx, dy, "--accent");
      this.text(c, `${short(Math.hypot(dx, dy) * aiming.gain)} m/s`, aiming.x, aiming.y + 16 * this.pixel, "--ink");
    }
  }

  drawHand(c) {
    const { n } = this.frame;
    if (!n[6]) return;
    c.strokeStyle = this.colour("--accent");
    c.lineWidth = 2 * this.pixel;
    c.setLineDash([5 * this.pixel, 4 * this.pixel]);
    c.beginPath();
    c.moveTo(n[7], n[8]);
    c.lineTo(n[9], n[10]);
    c.stroke();
    c.setLineDash([]);
    c.beginPath();
    c.arc(n[9], n[10], 4 * this.pixel, 0, 2 * Math.PI);
    c.stroke();
  }

  drawFlashes(c) {
    if (!this.flashes.length) return;
    const now = performance.now();
    this.flashes = this.flashes.filter((flash) => now - flash.at < FLASH);
    c.strokeStyle = this.colour("--accent");
    c.lineWidth = 2 * this.pixel;
    for (const flash of this.flashes) {
      const age = (now - flash.at) / FLASH;
      c.globalAlpha = 1 - age;
      c.beginPath();
      c.arc(flash.x, flash.y, (4 + 9 * age) * this.pixel, 0, 2 * Math.PI);
      c.stroke();
    }
    c.globalAlpha = 1;
    if (this.flashes.length === 0) this.changed = true; // once more without them
  }

  /** Numbers and plots: fast enough for eyes, at a quarter of the frames. */
  numbersShown() {
    const now = performance.now();
    if (this.stale && now - this.stale < 60) {
      this.changed = true;
      return;
    }
    this.stale = now;
    const { t, pace } = this.frame;
    this.clock.textContent = `${t.toFixed(this.span < 1 ? 3 : 2)} s`;
    const slow = !this.state?.paused && pace < 0.8;
    this.lag.textContent = slow ? `Too much work: ${Math.round(100 * pace)} % of the speed asked for` : "";
    this.pickedShown();
    const colour = (name) => this.colour(name);
    this.energy.draw(this.past, this.span, colour);
    this.momentum.draw(this.past, this.span, colour);
  }
}
