// Histograms of the bits that numbers took, beside the bits of their format.

const COLUMNS = 38, CELL = 8, HIGH = 24, ZERO = 16;

function drawRanges(section, ranges) {
  for (const row of section.querySelectorAll("tr[data-quantity]")) {
    const { bits, signed, counts, normalised } = ranges.find(({ quantity }) => quantity === row.dataset.quantity);
    const usable = bits - (signed ? 1 : 0), width = ZERO + COLUMNS * CELL, right = (left) => width - left * CELL;
    const svg = row.querySelector("svg");
    svg.setAttribute("viewBox", `0 0 ${width} ${HIGH}`);
    svg.setAttribute("width", width);
    svg.setAttribute("height", HIGH);
    const most = Math.log(1 + Math.max(...counts)), height = (count) => (HIGH - 4) * Math.log(1 + count) / most;
    const top = counts.reduce((last, count, n) => (count ? n : last), 0);
    drawn(svg, "rect", { class: "format", x: right(usable), y: 1, width: usable * CELL, height: HIGH - 2 });
    const free = usable - top;
    if (!normalised && free)
      drawn(svg, "rect", { class: "headroom", x: right(free), y: 1, width: free * CELL, height: HIGH - 2 });
    counts.forEach((count, n) => {
      if (!count) return;
      const x = n ? right(usable - n + 1) : 0;
      drawn(svg, "rect", { class: n ? "bin" : "bin none", x: x + 0.5, y: HIGH - 1 - height(count), width: CELL - 1,
                           height: height(count) });
    });
  }
}
