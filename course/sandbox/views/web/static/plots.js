// Small plots of energy and momentum over time.
import { h, round, short, tick } from "./camera.js";

export const ENERGY = [
  ["kinetic", "of motion", "--kinetic"],
  ["potential", "of height", "--potential"],
  ["contacts", "lost in contacts", "--contacts"],
  ["friction", "lost to friction", "--friction"],
  ["rods", "lost in rods", "--rods"],
  ["residual", "solver's error", "--residual"],
];
export const MOMENTUM = [
  ["px", "to the right", "--kinetic"],
  ["py", "upwards", "--contacts"],
];
const COLUMNS = ["t", ...ENERGY.map((s) => s[0]), ...MOMENTUM.map((s) => s[0])];

/** The past as columns; as many samples as fit, the oldest forgotten first. */
export class Past {
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

export class Plot {
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
      (this.sum = h("p", { class: "sum" })),
    );
  }

  draw(past, span, colour, shown, at = null) {
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
      this.values[i].textContent = short(shown[s.at], scale);
    });
    if (scale < 1e-12) high = 1;
    const pad = (high - low) * 0.06;
    c.font = "11px system-ui, sans-serif";
    const gap = round((high - low) / 3);
    const marks = [];
    for (let v = Math.ceil(low / gap) * gap; v <= high + gap * 1e-6; v += gap) {
      marks.push([v, Math.abs(v) < gap / 2 ? "0" : tick(v)]);
    }
    const left = Math.max(34, ...marks.map(([, text]) => c.measureText(text).width + 7));
    const x = (t) => left + ((t - end + span) / span) * (width - left - 2);
    const y = (v) => height - 4 - ((v - low + pad) / (high - low + 2 * pad)) * (height - 8);
    this.axes(c, marks, { y, width, left, colour });
    for (const s of drawn) this.line(c, rows, s, x, y, colour);
    if (at === null) return;
    c.fillStyle = colour("--accent");
    c.fillRect(x(at) - 0.75, 0, 1.5, height);
  }

  axes(c, marks, { y, width, left, colour }) {
    c.textAlign = "right";
    c.textBaseline = "middle";
    c.lineWidth = 1;
    for (const [v, text] of marks) {
      c.strokeStyle = colour(text === "0" ? "--axis" : "--grid");
      c.beginPath();
      c.moveTo(left, Math.round(y(v)) + 0.5);
      c.lineTo(width, Math.round(y(v)) + 0.5);
      c.stroke();
      c.fillStyle = colour("--quiet");
      c.fillText(text, left - 5, y(v));
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

