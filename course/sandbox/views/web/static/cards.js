// Cards that lie over the stage and never change its size: prediction, comparison, a body's numbers, the gallery.
import { Camera, h, outline, plain, short, spoken, unit } from "./camera.js";
import { Painter } from "./draw.js";

const button = (label, onclick, more = {}) => h("button", { type: "button", onclick, ...more }, label);

/** "Predict?", and after the run theory, guess and simulation side by side in a corner. */
export class Prediction {
  constructor(view) {
    this.view = view;
    this.chip = button("Predict?", () => this.open(), { class: "chip", hidden: true, "aria-expanded": "false" });
    this.element = h("section", { class: "card", "aria-label": "Prediction", hidden: true });
    this.said = "";
  }

  status(status, before) {
    const { stage, guess, comparison, question } = status;
    const { scene } = this.view;
    this.chip.hidden = !question;
    const guessed = guess === null ? "Predict?" : `Your guess: ${plain(guess)}${unit(scene.unit)}`;
    this.chip.textContent = stage === "touched" ? `You changed this run. ${guessed}` : guessed;
    this.chip.title = stage === "touched" ? "Theory is about the scene as it is: there is nothing to compare until the next run." : "";
    const key = JSON.stringify([stage, comparison]);
    if (before && stage === "done" && comparison && key !== this.said) {
      // Nobody's guess is taken out of their hands while they type it.
      if (!this.element.querySelector("form") || this.element.hidden) this.show(this.compare(comparison));
      this.view.tell(comparison.verdict);
    } else if (stage !== "done" && this.said.startsWith('["done"')) this.close();
    this.said = key;
    const asked = this.element.querySelector(".question"); // beside a field that the student may be typing in
    if (asked) asked.textContent = question;
  }

  open() {
    const { stage, comparison } = this.view.state;
    if (!this.view.scene.unit) return;
    this.view.say(""); // on a phone it would lie on the answer's button
    if (!this.element.hidden) this.close();
    else this.show(stage === "done" && comparison ? this.compare(comparison) : this.ask());
    this.element.querySelector("input, summary")?.focus();
  }

  show(inside) {
    this.element.replaceChildren(...inside, button("×", () => this.close(), { class: "close", "aria-label": "Close the prediction" }));
    this.element.hidden = false;
    this.chip.setAttribute("aria-expanded", "true");
    this.aside();
  }

  /** Into the corner where it hides the fewest bodies: at the bottom and right where no other is better. */
  aside() {
    const { view, element } = this;
    const into = (left, high) => {
      element.classList.toggle("left", left);
      element.classList.toggle("high", high);
    };
    const hidden = (corner) => {
      into(...corner);
      const box = element.getBoundingClientRect();
      const [left, top] = view.camera.place({ clientX: box.left, clientY: box.top });
      const [right, bottom] = view.camera.place({ clientX: box.right, clientY: box.bottom });
      return view.bodies.filter((body) => {
        const [x, y] = view.rowOf(body.name) ?? [NaN, NaN];
        const size = body.radius ?? 0;
        return !body.fixed && x + size > left && x - size < right && y + size > bottom && y - size < top;
      }).length;
    };
    const corners = [[false, false], [true, false], [true, true]];
    if (view.body.element.hidden) corners.push([false, true]); // else that body's numbers are there
    const counts = corners.map(hidden);
    into(...corners[counts.indexOf(Math.min(...counts))]);
  }

  close() {
    const hadFocus = this.element.contains(document.activeElement);
    this.element.hidden = true;
    this.chip.setAttribute("aria-expanded", "false");
    if (hadFocus) this.view.canvas.focus({ preventScroll: true });
  }

  ask() {
    const { view } = this;
    const field = h("input", { id: "guess", inputmode: "decimal", autocomplete: "off", size: "8" });
    const wrong = h("span", { class: "wrong", role: "alert" });
    const answer = (event) => {
      event.preventDefault();
      const text = field.value.trim().replace(",", ".").replace("−", "-");
      const value = Number(text);
      if (!text || !Number.isFinite(value)) {
        wrong.textContent = "A number, please.";
        field.focus();
      } else {
        view.send({ do: "guess", value });
        this.close();
      }
    };
    return [
      h("p", { class: "question" }, view.state.question),
      h(
        "form",
        { onsubmit: answer },
        h("label", { for: "guess" }, "Your guess"),
        field,
        h("span", { class: "unit" }, view.scene.unit === "1" ? "" : view.scene.unit),
        h("button", { class: "main" }, "Run and compare"),
        wrong,
      ),
    ];
  }

  compare(c) {
    const cell = (name, value, kind) =>
      h("div", { class: kind }, h("dt", {}, name), h("dd", {}, plain(value), h("small", {}, value === null ? "" : unit(c.unit))));
    const answers = [cell("Theory", c.theory, ""), cell("Simulation", c.simulation, c.agree ? "" : "off")];
    if (c.guess !== null) answers.unshift(cell("Your guess", c.guess, c.guess_right ? "right" : "off"));
    const again = () => {
      this.view.send({ do: "reset" });
      this.view.send({ do: "pause", on: false });
    };
    return [
      h("dl", { class: "answers" }, ...answers),
      h("p", { class: "verdict" }, c.verdict),
      h(
        "details",
        {},
        h("summary", {}, "Why, and once more"),
        h("p", {}, c.why),
        h("p", {}, h("strong", {}, "Think: "), this.view.scene.after),
        h("div", { class: "actions" }, button("Run again", again, { class: "main" }), button("Guess", () => this.show(this.ask()))),
      ),
    ];
  }
}

/** The body that is chosen: what it is, and its numbers to change. */
export class Body {
  constructor(view) {
    this.view = view;
    this.line = h("summary", {}, "No body is chosen");
    this.fields = h("div", { class: "fields" });
    const act = (what) => () => view.send({ do: what, name: view.chosen });
    this.element = h(
      "details",
      { class: "body", hidden: true },
      this.line,
      this.fields,
      h(
        "div",
        { class: "actions" },
        button("Copy", act("copy")),
        button("Delete", act("remove")),
        (this.following = button("Follow", () => view.follow(), { "aria-pressed": "false" })),
        (this.tracing = button("Trace", () => view.traceBody(), { "aria-pressed": "false" })),
      ),
    );
  }

  introduce(numbers) {
    const rows = numbers.map(({ name, unit: of, low, high }) => {
      const input = h("input", { id: `number-${name}`, inputmode: "decimal", autocomplete: "off", size: "6" });
      input.addEventListener("change", () => {
        const value = Number(input.value.replace(",", ".").replace("−", "-"));
        if (input.value.trim() === "" || !(value >= low && value <= high)) {
          this.view.say(`${name} is a number from ${plain(low)} to ${plain(high)}.`);
          this.view.repaint(); // with the number that it has
        } else this.view.send({ do: "change", name: this.view.chosen, key: name, value });
      });
      input.addEventListener("keydown", (event) => event.key === "Escape" && this.view.canvas.focus());
      return [name, input, h("label", { for: input.id }, name, h("small", {}, unit(of)))];
    });
    this.inputs = new Map(rows.map(([name, input]) => [name, input]));
    this.fields.replaceChildren(...rows.map(([, input, label]) => h("div", {}, label, input)));
  }

  open() {
    this.element.open = true;
    this.inputs.values().next().value?.focus();
  }

  show() {
    const { view } = this;
    const row = view.chosen && view.rowOf(view.chosen);
    this.element.hidden = !row;
    if (!row) return;
    const body = view.bodies.find((b) => b.name === view.chosen);
    const mass = body.mass ? `, ${plain(Number(body.mass.toPrecision(3)))} kg` : "";
    const small = (value) => (Math.abs(value) < 1e-4 ? 0 : value); // what is left of a body at rest
    this.line.textContent = `${spoken(view.chosen)}${mass}: ${short(small(Math.hypot(row[3], row[4])))} m/s`;
    const now = { mass: body.mass, restitution: body.restitution, friction: body.friction, vx: row[3], vy: row[4] };
    const { restitution, friction } = view.state.settings;
    if (restitution !== undefined) now.restitution = restitution;
    if (friction !== undefined) now.friction = friction;
    for (const [name, input] of this.inputs) {
      if (document.activeElement === input || now[name] === undefined) continue;
      const text = String(Number(small(now[name]).toPrecision(4)));
      if (input.value !== text) input.value = text;
    }
    this.following.setAttribute("aria-pressed", String(view.followed === view.chosen));
    this.tracing.setAttribute("aria-pressed", String(view.trace?.name === view.chosen));
  }
}

/** Every scene as a card that moves. */
export class Gallery {
  constructor(view) {
    this.view = view;
    this.grid = h("div", { class: "grid" });
    this.element = h(
      "section",
      { class: "gallery", "aria-label": "Scenes", hidden: true },
      h("header", {}, h("h2", {}, "Scenes"), button("Back", () => this.close(), { class: "back" })),
      this.grid,
    );
    this.cards = new Map();
    this.element.addEventListener("keydown", (event) => {
      if (event.key === "Escape") this.close();
      event.stopPropagation();
    });
  }

  get isOpen() {
    return !this.element.hidden;
  }

  open() {
    this.view.send({ do: "scenes" });
  }

  show(scenes) {
    const cards = scenes.map((scene) => {
      const canvas = h("canvas", { "aria-hidden": "true" });
      const played = scene.played ? h("span", { class: "played" }, "played") : null;
      const made = button("", () => this.view.send({ do: "open", id: scene.id }), { class: "scene" });
      made.append(canvas, h("strong", {}, scene.title), h("span", {}, scene.teaches), ...(played ? [played] : []));
      this.cards.set(scene.id, { ...scene, canvas, element: made });
      return made;
    });
    this.grid.replaceChildren(...cards);
    this.element.hidden = false;
    this.view.root.classList.add("covered");
    (this.cards.get(this.view.scene?.id)?.element ?? cards[0])?.focus();
  }

  close() {
    if (!this.isOpen) return;
    this.element.hidden = true;
    this.view.root.classList.remove("covered");
    this.view.canvas.focus({ preventScroll: true });
  }

  /** The bodies of a card; the numbers of how they move come next. */
  card({ id, bodies }) {
    this.next = this.cards.get(id);
    if (this.next) this.next.bodies = bodies.map((body) => ({ ...body, path: outline(body) }));
  }

  numbers(n) {
    const card = this.next;
    if (!card) return;
    const [, frames, count, joints] = n;
    card.camera = new Camera(card.canvas);
    card.camera.look(card.view);
    card.loop = { n, frames, count, joints };
    const owner = { bodies: [], ghost: {}, arrows: { checked: false }, colour: (name) => this.view.colour(name), colours: this.view.colours };
    card.painter = new Painter(owner, card.camera, card.canvas);
    card.owner = owner;
    this.paint(card, 0);
  }

  /** All of them one picture on, twenty times a second. */
  draw(now) {
    if (!this.isOpen || now - (this.drawn ?? 0) < 50) return;
    this.drawn = now;
    for (const card of this.cards.values()) if (card.loop) this.paint(card, this.view.still ? 0 : Math.floor(now / 50));
  }

  paint(card, number) {
    const { n, frames, count, joints } = card.loop;
    const { canvas, camera, owner } = card;
    if (canvas.width !== Math.round(canvas.clientWidth * camera.dense)) {
      camera.fit();
      canvas.width = Math.round(canvas.clientWidth * camera.dense);
      canvas.height = Math.round(canvas.clientHeight * camera.dense);
    }
    const at = number % frames;
    const packed = new Float32Array(24 + count * 5 + joints * 4);
    for (let i = 0; i < count; i++) packed.set(n.subarray(4 + (at * count + i) * 3).subarray(0, 3), 24 + i * 5);
    packed.set(n.subarray(4 + frames * count * 3 + at * joints * 4).subarray(0, joints * 4), 24 + count * 5);
    owner.colours = this.view.colours;
    owner.bodies = card.bodies;
    owner.frame = { t: 0, count, joints, n: packed };
    card.painter.draw();
  }
}
