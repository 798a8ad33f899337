// What every other module needs: elements, numbers in words, and the window onto a world.

export const HEAD = 24; // numbers in front of the bodies of a frame
export const PER_BODY = 5; // x, y, angle, vx, vy

export function h(tag, attributes = {}, ...children) {
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
export function short(value, scale = 0) {
  if (value === null || !Number.isFinite(value)) return "–";
  if (Math.abs(value) <= 2e-6 * scale || value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e5 || size < 1e-3) return value.toExponential(1).replaceAll("-", "−");
  const text = size >= 100 ? value.toFixed(0) : size >= 10 ? value.toFixed(1) : value.toFixed(size >= 1 ? 2 : 3);
  return text.replaceAll("-", "−");
}

/** A round number in few letters. */
export function tick(value) {
  const text = String(Number(value.toPrecision(2)));
  return (text.length > 5 ? value.toExponential(0) : text).replaceAll("-", "−");
}

/** A number as it was meant: up to six digits, none that say nothing. */
export const plain = (value) => (value === null ? "did not happen" : String(Number(value.toPrecision(6))).replaceAll("-", "−"));
export const spoken = (name) => name.replaceAll("-", " ");
export const amount = (value, of) => {
  const small = of === "s" && value < 0.1;
  return plain(Number((small ? 1000 * value : value).toPrecision(3))) + unit(small ? "ms" : of);
};
export const unit = (text) => (text === "1" || !text ? "" : ` ${text}`);

/** The values a slider can take: fine near where worlds usually are, coarse far out. */
export function stops(knob, current) {
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

export function nearest(values, wanted) {
  let best = 0;
  values.forEach((value, i) => {
    if (Math.abs(value - wanted) < Math.abs(values[best] - wanted)) best = i;
  });
  return best;
}

/** The next round number from this size up: 1, 2 or 5 times a power of ten. */
export function round(size) {
  const power = 10 ** Math.floor(Math.log10(size));
  return power * [1, 2, 5, 10].find((step) => step * power >= size * 0.999);
}

export function outline(body) {
  const path = new Path2D();
  if (body.shape === "circle") path.arc(0, 0, body.radius, 0, 2 * Math.PI);
  else {
    body.outline.forEach(([px, py], i) => (i ? path.lineTo(px, py) : path.moveTo(px, py)));
    if (body.shape === "polygon") path.closePath();
  }
  return path;
}

/** How far a point in the body's frame is from its surface; 0 inside. */
export function distance(body, px, py) {
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


/** Which part of a world is seen: all of its view at first, then as wheel, fingers and keys have it. */
export class Camera {
  constructor(canvas) {
    this.canvas = canvas;
    this.view = [0, 0, 1, 1];
    this.reset();
  }

  reset() {
    this.zoom = 1;
    this.off = [0, 0]; // from the middle of the view, in m
    this.fit();
  }

  look(view) {
    this.view = view;
    this.reset();
  }

  fit() {
    const { clientWidth, clientHeight } = this.canvas;
    const [left, bottom, right, top] = this.view;
    this.dense = Math.min(devicePixelRatio || 1, 2);
    this.scale = (Math.min(clientWidth / (right - left), clientHeight / (top - bottom)) || 1) * this.zoom;
    this.middle = [clientWidth / 2, clientHeight / 2];
    this.centre = [(left + right) / 2 + this.off[0], (bottom + top) / 2 + this.off[1]];
  }

  get pixel() {
    return 1 / this.scale;
  }

  /** The place under a point of the page. */
  place({ clientX, clientY }) {
    const box = this.canvas.getBoundingClientRect();
    return [
      (clientX - box.left - this.middle[0]) / this.scale + this.centre[0],
      this.centre[1] - (clientY - box.top - this.middle[1]) / this.scale,
    ];
  }

  /** Larger or smaller, with the place under a point staying where it is. */
  zoomBy(factor, at = null) {
    const before = at && this.place(at);
    this.zoom = Math.min(40, Math.max(0.2, this.zoom * factor));
    this.fit();
    if (before) {
      const after = this.place(at);
      this.pan(before[0] - after[0], before[1] - after[1]);
    }
  }

  pan(dx, dy) {
    this.off = [this.off[0] + dx, this.off[1] + dy];
    this.fit();
  }

  follow(x, y) {
    const [left, bottom, right, top] = this.view;
    this.off = [x - (left + right) / 2, y - (bottom + top) / 2];
    this.fit();
  }
}
