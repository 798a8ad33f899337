// A world on a canvas.
import { HEAD, PER_BODY, round, short } from "./camera.js";

const FLASH = 350; // ms that a contact glows

/** Draws one frame after the other of what a view knows. */
export class Painter {
  constructor(view, camera, canvas) {
    this.view = view;
    this.camera = camera;
    this.canvas = canvas;
    this.flashes = [];
  }

  flash(events) {
    const at = performance.now();
    for (const event of events) if (event.x !== undefined) this.flashes.push({ ...event, at });
    this.flashes = this.flashes.slice(-24);
  }

  colour(name) {
    return this.view.colour(name);
  }

  get pixel() {
    return this.camera.pixel;
  }

  draw() {
    const { view, canvas, camera } = this;
    const { dense, middle, centre, scale } = camera;
    const c = canvas.getContext("2d");
    const s = scale * dense;
    const [ox, oy] = [(middle[0] - centre[0] * scale) * dense, (middle[1] + centre[1] * scale) * dense];
    c.setTransform(1, 0, 0, 1, 0, 0);
    c.clearRect(0, 0, canvas.width, canvas.height);
    const flat = () => c.setTransform(s, 0, 0, -s, ox, oy);
    flat();
    this.grid(c);
    if (view.ghost.frame) {
      c.globalAlpha = 0.28;
      this.cast(c, view.ghost, s, ox, oy, flat);
      c.globalAlpha = 1;
    }
    flat();
    this.drawTrace(c);
    this.cast(c, view, s, ox, oy, flat);
    flat();
    this.drawArrows(c);
    this.drawHand(c);
    this.drawFlashes(c);
  }

  /** Bodies and joints of one frame. */
  cast(c, { bodies, frame }, s, ox, oy, flat) {
    flat();
    this.drawJoints(c, frame);
    bodies.forEach((body, i) => this.drawBody(c, body, rowOf(frame, i), s, ox, oy));
  }

  drawTrace(c) {
    const { trace, frame } = this.view;
    if (!trace) return;
    c.strokeStyle = this.colour("--accent");
    c.lineWidth = 1.5 * this.pixel;
    c.globalAlpha = 0.6;
    c.beginPath();
    for (const [t, x, y] of trace.rows) if (t <= frame.t + 1e-6) c.lineTo(x, y);
    c.stroke();
    c.globalAlpha = 1;
  }

  grid(c) {
    const { scale, middle, centre } = this.camera;
    const gap = round(50 / scale);
    const [w, t] = [middle[0] / scale, middle[1] / scale];
    const [x0, y0] = centre;
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
    const chosen = body.name === this.view.chosen;
    if (body.wheels) this.wheels(c, body);
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
    const { colours } = this.view;
    if (!colours || colours[key] === undefined) {
      const light = (hex) => [1, 3, 5].reduce((sum, at, i) => sum + [0.21, 0.72, 0.07][i] * parseInt(hex.slice(at, at + 2), 16), 0);
      const far = Math.abs(light(body.colour) - light(this.colour("--paper")));
      this.view.colours[key] = far < 40;
    }
    return this.view.colours[key];
  }

  wheels(c, body) {
    const xs = body.outline.map(([px]) => px);
    const [long, wide] = [(Math.max(...xs) - Math.min(...xs)) * 0.4, body.wheels.track * 0.18];
    c.fillStyle = this.colour("--ink");
    for (const side of [-1, 1]) c.fillRect(-long / 2, (side * body.wheels.track) / 2 - wide / 2 + side * wide * 0.4, long, wide);
    c.strokeStyle = this.colour("--ink");
    c.lineWidth = 2 * this.pixel;
    c.beginPath();
    c.moveTo(Math.max(...xs), 0);
    c.lineTo(Math.max(...xs) + wide * 1.5, 0);
    c.stroke();
  }

  drawJoints(c, { n, joints, count }) {
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

  /** Arrows of velocity; while time stands their tips are handles. */
  drawArrows(c) {
    const { view } = this;
    const { frame, pointer, gain } = view;
    if (!view.arrows.checked && !view.state?.paused) return;
    view.bodies.forEach((body, i) => {
      if (body.fixed) return;
      const [x, y, , vx, vy] = rowOf(frame, i);
      const aimed = pointer?.aim && body.name === pointer.name;
      const [dx, dy] = aimed ? [pointer.x - x, pointer.y - y] : [vx / gain, vy / gain];
      this.arrow(c, x, y, dx, dy, aimed ? "--accent" : "--ink");
      if (aimed) this.text(c, `${short(Math.hypot(dx, dy) * gain)} m/s`, pointer.x, pointer.y + 16 * this.pixel, "--ink");
      if (body.name !== view.chosen || !view.state?.paused || view.state.at !== null) return;
      c.strokeStyle = this.colour("--accent");
      c.lineWidth = 2 * this.pixel;
      c.beginPath();
      c.arc(...view.tools.tip(body, x, y, dx, dy), 6 * this.pixel, 0, 2 * Math.PI);
      c.stroke();
    });
  }

  drawHand(c) {
    const { n } = this.view.frame;
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
    if (this.flashes.length === 0) this.view.changed = true; // once more without them
  }

}

export function rowOf(frame, i) {
  const at = HEAD + i * PER_BODY;
  return frame.n.subarray(at, at + PER_BODY);
}
