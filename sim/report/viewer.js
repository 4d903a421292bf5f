// The picture of one scene with its controls; calls the functions in `onframe` with each new frame.

const SLOWER = [1, 2, 5, 10, 20, 50, 100];
const TURN = Math.PI / 24;

// Returns the first state: the deformed object, at the end of its first phase or in the middle of a single one.
function initialState(recording) {
  const steady = recording.ratio.circuit.high - recording.ratio.circuit.low <= 0.1001;
  return { frame: recording.nearest(recording.phases[0].end * (recording.phases.length > 1 ? 1 : 0.5)),
           run: "circuit", colour: steady ? "force" : "ratio", times: 1, inside: false };
}

class Viewer {
  constructor(section, recording, scales) {
    this.section = section;
    this.recording = recording;
    this.scales = scales;
    this.canvas = section.querySelector("canvas");
    this.camera = new Camera(recording);
    this.onframe = [];
    this.state = initialState(recording);
    this.playing = false;
    this.connect();
    new ResizeObserver(() => this.paint()).observe(this.canvas);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.paint());
    this.show({});
  }

  control(role) {
    return this.section.querySelector(`[data-role="${role}"]`);
  }

  connect() {
    const { recording, state } = this;
    this.play = this.control("play");
    this.slider = this.control("frame");
    this.slider.max = recording.count - 1;
    this.play.addEventListener("click", () => this.toggle());
    this.slider.addEventListener("input", () => (this.pause(), this.show({ frame: Number(this.slider.value) })));
    for (const name of ["run", "colour"])
      for (const input of this.section.querySelectorAll(`input[data-role="${name}"]`)) {
        input.checked = input.value === state[name];
        input.addEventListener("change", () => this.show({ [name]: input.value }));
      }
    const inside = this.control("inside"), times = this.control("times"), speed = this.control("speed");
    inside.addEventListener("change", () => this.show({ inside: inside.checked }));
    times.addEventListener("change", () => this.show({ times: times.checked ? recording.magnified : 1 }));
    this.control("magnified").textContent = recording.magnified.toLocaleString("en").replaceAll(",", "\u202f");
    const wanted = 6 / recording.t[recording.count - 1]; // s for the whole run
    this.slower = SLOWER.reduce((best, one) =>
      Math.abs(Math.log(one / wanted)) < Math.abs(Math.log(best / wanted)) ? one : best);
    for (const one of SLOWER) speed.add(new Option(one === 1 ? "in real time" : `${one} times slower`, one));
    speed.value = this.slower;
    speed.addEventListener("change", () => { this.slower = Number(speed.value); });
    this.connectPointer();
    this.canvas.addEventListener("keydown", (event) => this.key(event));
  }

  connectPointer() {
    const canvas = this.canvas;
    let last = null;
    canvas.addEventListener("pointerdown", (event) => {
      if (!this.recording.dim3) return;
      last = [event.clientX, event.clientY];
      canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener("pointermove", (event) => {
      if (!last) return;
      this.camera.turn(-0.01 * (event.clientX - last[0]), 0.01 * (event.clientY - last[1]));
      last = [event.clientX, event.clientY];
      this.paint();
    });
    for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, () => { last = null; });
  }

  key(event) {
    const turns = { ArrowLeft: [-TURN, 0], ArrowRight: [TURN, 0], ArrowUp: [0, TURN], ArrowDown: [0, -TURN] };
    const { frame } = this.state, last = this.recording.count - 1;
    const frames = { Home: 0, End: last, ",": Math.max(0, frame - 1), ".": Math.min(last, frame + 1) };
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    if (event.key === " ") this.toggle();
    else if (event.key in frames) this.pause(), this.show({ frame: frames[event.key] });
    else if (event.key in turns && this.recording.dim3) this.camera.turn(...turns[event.key]), this.paint();
    else if (event.key === "+" || event.key === "-") {
      this.camera.zoom = Math.max(0.5, Math.min(4, this.camera.zoom * (event.key === "+" ? 1.2 : 1 / 1.2)));
      this.paint();
    } else if (event.key === "0") this.camera.reset(), this.paint();
    else return;
    event.preventDefault();
  }

  toggle() {
    if (this.playing) return this.pause();
    const { recording } = this;
    if (this.state.frame === recording.count - 1) this.show({ frame: 0 });
    this.playing = true;
    this.play.textContent = "Pause";
    let began = null;
    const from = recording.t[this.state.frame];
    const tick = (now) => {
      if (!this.playing) return;
      began ??= now;
      const time = from + (now - began) / 1000 / this.slower;
      let { frame } = this.state;
      while (frame < recording.count - 1 && recording.t[frame + 1] <= time) frame++;
      if (frame !== this.state.frame) this.show({ frame });
      if (frame === recording.count - 1) this.pause();
      else requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  pause() {
    this.playing = false;
    this.play.textContent = "Play";
  }

  show(change) {
    const { recording, state } = this;
    Object.assign(state, change);
    const { frame } = state, phase = recording.phases[recording.phase(frame)].name;
    this.slider.value = frame;
    this.section.dataset.frame = frame;
    const time = `${si(recording.t[frame], "s", recording.t[recording.count - 1])}`;
    this.slider.setAttribute("aria-valuetext", `${time}, ${phase}`);
    this.control("time").textContent = `${time} · ${phase} · frame ${frame + 1} of ${recording.count}`;
    this.paint();
    this.legend();
    for (const told of this.onframe) told(frame);
  }

  paint() {
    const { canvas } = this, { width, height } = canvas.getBoundingClientRect(), dense = devicePixelRatio || 1;
    if (!width) return;
    if (canvas.width !== Math.round(width * dense) || canvas.height !== Math.round(height * dense))
      [canvas.width, canvas.height] = [Math.round(width * dense), Math.round(height * dense)];
    const context = canvas.getContext("2d");
    context.setTransform(dense, 0, 0, dense, 0, 0);
    paint(context, this.recording, this.camera, this.state, this.scales, theme(width, height));
  }

  legend() {
    const { recording, state } = this, both = state.run === "both";
    this.control("scale").hidden = both;
    this.control("lines").hidden = !both;
    this.control("colours").disabled = both;
    const { low, high } = recording.ratio.circuit, full = recording.force.circuit.high;
    const apart = recording.largest_apart;
    const named = {
      ratio: ["ratio a of the edges; beyond the ends the same colour",
              ...[low, (low + high) / 2, high].map((ratio) => ratio.toFixed(2))],
      force: ["force of the edges: below 0 they pull, above they push; beyond the ends the same colour",
              si(-full, "N"), "0", si(full, "N")],
      apart: [`distance of circuit and float64; ${si(apart, "m")} are ${power(apart / recording.size)} of the size`,
              "0", si(apart / 2, "m", apart), si(apart, "m")],
    }[state.colour];
    this.control("bar").style.background = `linear-gradient(to right, ${this.scales[state.colour].colours.join(", ")})`;
    ["title", "low", "middle", "high"].forEach((role, n) => { this.control(role).textContent = named[n]; });
  }
}

function power(x) {
  return x === 0 ? "0" : x.toExponential(1).replace(".0e", "e").replace("e+", "e");
}

// Returns what a picture of this size takes from the page's style.
function theme(width, height, plain = false) {
  const style = getComputedStyle(document.documentElement), result = { width, height, plain };
  for (const name of ["ink", "quiet", "under", "line", "wide", "circuit", "bound"])
    result[name] = style.getPropertyValue(`--${name}`).trim();
  const [hue, most] = ["paper", "paper-light"].map((name) => style.getPropertyValue(`--${name}`).trim());
  result.paper = (light) => `hsl(${hue} ${Math.round(most * light)}%)`;
  return result;
}
