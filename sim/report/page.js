// Brings a scene to life when it is about to be seen.

const scales = Object.fromEntries(Object.entries(JSON.parse(document.getElementById("colours").textContent))
  .map(([name, colours]) => [name, new Scale(colours)]));
const viewers = new Map(), recordings = new Map();

function recordingOf(section) {
  if (!recordings.has(section.id))
    recordings.set(section.id, new Recording(JSON.parse(section.querySelector("script").textContent)));
  return recordings.get(section.id);
}

function begin(section) {
  if (viewers.has(section.id)) return viewers.get(section.id);
  const recording = recordingOf(section), { curves } = recording;
  const viewer = new Viewer(section, recording, scales);
  viewers.set(section.id, viewer);
  const common = { t: curves.t, phases: recording.phases,
                   seek: (time) => (viewer.pause(), viewer.show({ frame: recording.nearest(time) })) };
  const two = (values) => [{ name: "float64", kind: "float64", values: values.float64 },
                           { name: "circuit", kind: "circuit", values: values.circuit }];
  const energies = ["kinetic", "elastic", "gravity", "dissipated", "work"]
    .filter((name) => curves.energy[name].some((value) => value));
  const charts = {
    apart: { unit: "", log: true, series: [{ name: "largest, over the nodes", kind: "circuit", values: curves.dx_rel }],
             lines: [{ value: curves.bound, text: `allowed: ${power(curves.bound)}`, kind: "bound" },
                     { value: curves.last_bit, text: "last bit of a position", kind: "last" }] },
    force: { unit: "N", series: two(curves.force) },
    height: { unit: "m", series: two(curves.height) },
    energy: { unit: "J", series: energies.map((name) => ({ name, kind: name, values: curves.energy[name] })) },
  };
  for (const [name, chart] of Object.entries(charts)) {
    const made = new Chart(section.querySelector(`[data-chart="${name}"]`), { ...common, ...chart });
    viewer.onframe.push((frame) => made.at(recording.frames[frame]));
  }
  const details = section.querySelector("details"), draw = () => details.open && drawRanges(section, recording.ranges);
  details.addEventListener("toggle", draw, { once: true });
  draw();
  viewer.show({});
  section.dataset.ready = "yes";
  return viewer;
}

// Draws the small pictures at the top, one at a time while the browser is idle.
const cards = [...document.querySelectorAll("nav.cards a")];
function paintCard(card) {
  const canvas = card.querySelector("canvas"), { width, height } = canvas.getBoundingClientRect();
  const dense = devicePixelRatio || 1, context = canvas.getContext("2d");
  [canvas.width, canvas.height] = [width * dense, height * dense];
  context.setTransform(dense, 0, 0, dense, 0, 0);
  const recording = recordingOf(document.getElementById(card.hash.slice(1)));
  const state = { ...initialState(recording), plain: true };
  paint(context, recording, new Camera(recording), state, scales, theme(width, height, true));
}
const idle = window.requestIdleCallback || ((work) => setTimeout(work, 1));
function paintCards(rest) {
  if (rest.length) idle(() => (paintCard(rest[0]), paintCards(rest.slice(1))));
}
// after the visible scenes
requestAnimationFrame(() => requestAnimationFrame(() => paintCards(cards)));
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => paintCards(cards));

const near = new IntersectionObserver((entries) => {
  for (const entry of entries) if (entry.isIntersecting) near.unobserve(entry.target), begin(entry.target);
}, { rootMargin: "400px" });
for (const section of document.querySelectorAll("section[data-scene]")) near.observe(section);
addEventListener("beforeprint", () => document.querySelectorAll("section[data-scene]").forEach(begin));
document.documentElement.dataset.ready = "yes";
