// Curves over time with a line at the frame in the picture; press or drag to move it.

const SVG = "http://www.w3.org/2000/svg";
const FRAME = { left: 52, right: 18, top: 18, bottom: 34, height: 240 };

function drawn(parent, name, attributes, text) {
  const element = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (text !== undefined) element.textContent = text;
  parent.append(element);
  return element;
}

// Returns about so many round numbers between two others.
function ticks(low, high, about) {
  const raw = (high - low) / about, decade = 10 ** Math.floor(Math.log10(raw));
  const step = decade * [1, 2, 5, 10].find((digit) => digit * decade >= raw * 0.999);
  const result = [];
  for (let n = Math.ceil(low / step - 1e-9); n * step <= high + 1e-9 * step; n++) result.push(n * step);
  return result;
}

// `series`: {name, values, kind}, where kind is a class of the page's style; `lines`: {value, text, kind}, horizontal.
class Chart {
  constructor(figure, { t, phases, series, unit, log, lines, seek }) {
    Object.assign(this, { figure, t, phases, series, unit, log, lines: lines || [] });
    this.svg = figure.querySelector("svg");
    this.key = figure.querySelector(".key");
    this.read = series.map(({ name, kind }) => {
      const item = document.createElement("span");
      item.className = kind;
      item.append(document.createElement("i"), `${name} `, document.createElement("b"));
      this.key.append(item);
      return item.lastChild;
    });
    const go = (event) => seek(this.time(event));
    this.svg.addEventListener("pointerdown", (event) => (this.svg.setPointerCapture(event.pointerId), go(event)));
    this.svg.addEventListener("pointermove", (event) => event.buttons && go(event));
    new ResizeObserver(() => this.paint()).observe(figure);
    this.now = 0;
    this.paint();
  }

  time(event) {
    const { left, right } = FRAME, box = this.svg.getBoundingClientRect();
    const part = (event.clientX - box.left - left) / (box.width - left - right);
    return Math.max(0, Math.min(1, part)) * this.t[this.t.length - 1];
  }

  // True if the axis can show a value.
  there(value) {
    return value !== null && (!this.log || value > 0);
  }

  limits() {
    const known = this.series.flatMap(({ values }) => values.filter((value) => this.there(value)));
    const all = [...known, ...this.lines.map(({ value }) => value)];
    if (this.log) { // values far below the lowest line are of no interest
      const lowest = Math.max(Math.min(...all), Math.min(...this.lines.map(({ value }) => value)) / 5);
      return [Math.floor(Math.log10(lowest)), Math.ceil(Math.log10(Math.max(...all) * 2))];
    }
    const [low, high] = [Math.min(0, ...all), Math.max(...all)];
    return low === high ? [low, low + 1] : [low - (low < 0 ? 0.06 : 0) * (high - low), high + 0.06 * (high - low)];
  }

  paint() {
    const width = this.figure.clientWidth, { left, right, top, bottom, height } = FRAME;
    if (!width) return;
    const svg = this.svg, [low, high] = this.limits(), last = this.t[this.t.length - 1];
    svg.replaceChildren();
    svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    this.x = (t) => left + t / last * (width - left - right);
    this.y = (value) => height - bottom
      - Math.max(0, (this.log ? Math.log10(value) : value) - low) / (high - low) * (height - top - bottom);
    const [prefix, factor] = this.log ? ["", 1] : prefixFor(Math.max(Math.abs(low), Math.abs(high)));
    const decades = Array.from({ length: high - low + 1 }, (_, n) => low + n);
    const marks = this.log ? decades.filter((n) => high - low < 6 || n % 2 === 0)
      : ticks(low / factor, high / factor, 4);
    for (const mark of marks) {
      const y = this.y(this.log ? 10 ** mark : mark * factor);
      drawn(svg, "line", { class: "grid", x1: left, x2: width - right, y1: y, y2: y });
      const label = drawn(svg, "text", { class: "tick", x: left - 6, y: y + 4, "text-anchor": "end" },
                          this.log ? "10" : number(Number(mark.toPrecision(6))));
      if (this.log) drawn(label, "tspan", { dy: -5, "font-size": "0.75em" }, String(mark).replace("-", "\u2212"));
    }
    if (this.unit) drawn(svg, "text", { class: "tick", x: 2, y: 11 }, `${prefix}${this.unit}`);
    for (const mark of ticks(0, last, Math.max(2, Math.min(6, width / 90))))
      drawn(svg, "text", { class: "tick", x: this.x(mark), y: height - bottom + 16, "text-anchor": "middle" },
            String(Number(mark.toPrecision(6))));
    drawn(svg, "text", { class: "tick", x: width - right, y: height - 4, "text-anchor": "end" }, "time (s)");
    let start = 0;
    for (const { name, end } of this.phases) {
      drawn(svg, "line", { class: "phase", x1: this.x(start), x2: this.x(start), y1: top, y2: height - bottom });
      if (this.x(end) - this.x(start) > 7 * name.length)
        drawn(svg, "text", { class: "tick", x: this.x((start + end) / 2), y: 11, "text-anchor": "middle" }, name);
      start = end;
    }
    for (const { value, text, kind } of this.lines) {
      const y = this.y(value);
      drawn(svg, "line", { class: `across ${kind}`, x1: left, x2: width - right, y1: y, y2: y });
      drawn(svg, "text", { class: `tick ${kind}`, x: width - right, y: y - 4, "text-anchor": "end" }, text);
    }
    for (const { values, kind } of this.series) drawn(svg, "path", { class: `curve ${kind}`, d: this.outline(values) });
    this.cursor = drawn(svg, "line", { class: "now", y1: top, y2: height - bottom });
    this.at(this.now);
  }

  outline(values) {
    let result = "", on = false;
    values.forEach((value, n) => {
      const there = this.there(value);
      if (there) result += `${on ? "L" : "M"}${this.x(this.t[n]).toFixed(1)} ${this.y(value).toFixed(1)}`;
      on = there;
    });
    return result;
  }

  // Moves to a frame of the run, which may be one that isn't drawn.
  at(frame) {
    this.now = frame;
    if (!this.cursor) return;
    this.cursor.setAttribute("x1", this.x(this.t[frame]));
    this.cursor.setAttribute("x2", this.x(this.t[frame]));
    this.series.forEach(({ values }, n) => {
      const value = values[frame];
      this.read[n].textContent = value === null ? "–" : this.log ? power(value)
        : si(value, this.unit, Math.max(...values.map(Math.abs)));
    });
  }
}
