// Paints an object on a canvas.

class Scale {
  constructor(colours) {
    this.colours = colours;
    const parts = colours.map((colour) => [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16)));
    this.table = Array.from({ length: 256 }, (_, level) => {
      const place = level / 255 * (parts.length - 1), n = Math.min(parts.length - 2, Math.floor(place));
      return parts[n].map((part, channel) => part + (place - n) * (parts[n + 1][channel] - part));
    });
  }

  // Returns a colour of which `part` is replaced by white, then darkened by `light`.
  rgb(shade, light = 1, part = 0) {
    const mixed = this.table[Math.max(0, Math.min(255, Math.round(shade * 255)))]
      .map((channel) => Math.round(light * (channel + part * (255 - channel))));
    return `rgb(${mixed.join(",")})`;
  }
}

const PALE = 0.5; // part of an edge's colour on the faces beside it

// `state`: frame, run ("circuit", "float64" or "both"), colour ("ratio", "force" or "apart"), times, inside, plain.
function paint(context, recording, camera, state, scales, theme) {
  const { width, height } = theme;
  context.clearRect(0, 0, width, height);
  camera.fit(theme);
  const float64 = camera.project(recording.positions(state.frame, 0));
  const circuit = state.run === "float64" ? float64
    : camera.project(recording.positions(state.frame, state.times));
  const both = state.run === "both", points = both ? float64 : circuit;
  context.lineJoin = context.lineCap = "round";

  if (!state.plain) paintOutline(context, recording, camera, theme);
  const shades = recording.shades(state.frame, state.colour, state.run === "float64" ? "float64" : "circuit");
  const scale = scales[state.colour];
  if (state.inside) paintEdges(context, recording, points, circuit, both, shades, scale, theme);
  else paintFaces(context, recording, points, circuit, both, shades, scale, theme, state.colour === "apart" ? 0 : PALE);
  if (state.plain) return;
  paintHeld(context, recording, state, points, theme);
  paintRuler(context, camera, theme);
}

function path(context, points, ...nodes) {
  context.beginPath();
  for (const node of nodes) context.lineTo(points[3 * node], points[3 * node + 1]);
}

function stroke(context, colour, width) {
  context.strokeStyle = colour;
  context.lineWidth = width;
  context.stroke();
}

function paintFaces(context, recording, points, circuit, both, shades, scale, theme, pale) {
  const faces = recording.faces, order = [];
  for (let f = 0; f < faces.length; f += 3) {
    const [a, b, c] = [3 * faces[f], 3 * faces[f + 1], 3 * faces[f + 2]];
    const u = [points[b] - points[a], points[b + 1] - points[a + 1], points[b + 2] - points[a + 2]];
    const v = [points[c] - points[a], points[c + 1] - points[a + 1], points[c + 2] - points[a + 2]];
    const normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    if (recording.dim3 && normal[2] >= 0) continue; // faces away: y points down on a canvas
    const length = Math.hypot(...normal) || 1;
    const lit = Math.max(0, (0.25 * normal[0] + 0.75 * normal[1] - 0.61 * normal[2]) / length);
    order.push([points[a + 2] + points[b + 2] + points[c + 2], f, recording.dim3 ? 0.8 + 0.2 * lit : 1]);
  }
  order.sort((one, other) => one[0] - other[0]);
  const sides = [0, 1, 2];
  // the second run is painted over the first; a solid's faces hide what is behind them in both
  const passes = !both ? ["fill own"] : recording.dim3 ? ["fill float64 circuit"] : ["fill", "float64", "circuit"];
  for (const pass of passes)
    for (const [, f, light] of order) {
      const [a, b, c] = [faces[f], faces[f + 1], faces[f + 2]];
      const own = sides.map((side) => shades[recording.faceEdges[f + side]]);
      if (pass.includes("fill")) {
        path(context, points, a, b, c);
        context.closePath();
        context.fillStyle = both ? theme.paper(light) : scale.rgb((own[0] + own[1] + own[2]) / 3, light, pale);
        context.fill();
        if (!both) stroke(context, context.fillStyle, 0.7); // no gap between faces
      }
      for (const side of sides) {
        const [p, q] = [faces[f + side], faces[f + (side + 1) % 3]];
        if (pass.includes("float64")) path(context, points, p, q), stroke(context, theme.wide, 4);
        if (pass.includes("own")) {
          path(context, points, p, q);
          if (pale) stroke(context, scale.rgb(own[side], 0.5 + 0.5 * light), theme.plain ? 1.2 : 2.4);
          else stroke(context, theme.line, 0.8);
        }
      }
      if (pass.includes("circuit")) {
        path(context, circuit, a, b, c);
        context.closePath();
        stroke(context, theme.circuit, 1.4);
      }
    }
}

function paintEdges(context, recording, points, circuit, both, shades, scale, theme) {
  const edges = recording.edges, order = [];
  for (let e = 0; e < recording.edgeCount; e++)
    order.push([points[3 * edges[2 * e] + 2] + points[3 * edges[2 * e + 1] + 2], e]);
  order.sort((one, other) => one[0] - other[0]);
  for (const [, e] of order) {
    path(context, points, edges[2 * e], edges[2 * e + 1]);
    stroke(context, both ? theme.wide : theme.under, both ? 4 : 3.4);
    if (!both) stroke(context, scale.rgb(shades[e]), 2.4);
  }
  if (!both) return;
  for (const [, e] of order) {
    path(context, circuit, edges[2 * e], edges[2 * e + 1]);
    stroke(context, theme.circuit, 1.4);
  }
}

function paintOutline(context, recording, camera, theme) {
  const points = camera.project(recording.outline);
  context.setLineDash([5, 4]);
  for (let n = 0; n < points.length / 3; n += 2) path(context, points, n, n + 1), stroke(context, theme.quiet, 1);
  context.setLineDash([]);
}

// Paints squares on the nodes fixed in this phase and discs on driven ones; of a solid, only the nodes in front.
function paintHeld(context, recording, state, points, theme) {
  const held = recording.held[recording.phase(state.frame)], front = new Set();
  if (recording.dim3)
    for (let f = 0; f < recording.faces.length; f += 3) {
      const [a, b, c] = [3 * recording.faces[f], 3 * recording.faces[f + 1], 3 * recording.faces[f + 2]];
      const area = (points[b] - points[a]) * (points[c + 1] - points[a + 1])
        - (points[b + 1] - points[a + 1]) * (points[c] - points[a]);
      if (area < 0) for (const corner of [a, b, c]) front.add(corner / 3);
    }
  for (const [nodes, colour, square] of [[held.fixed, theme.ink, true], [held.driven, theme.bound, false]])
    for (const node of nodes) {
      if (recording.dim3 && !state.inside && !front.has(node)) continue;
      const [x, y] = [points[3 * node], points[3 * node + 1]];
      context.beginPath();
      if (square) context.rect(x - 3.5, y - 3.5, 7, 7);
      else context.arc(x, y, 4, 0, 2 * Math.PI);
      context.fillStyle = colour;
      context.fill();
      stroke(context, theme.under, 1.2);
    }
}

function paintRuler(context, camera, theme) {
  const length = roundBelow(0.28 * theme.width / camera.scale);
  const [x, y] = [18, theme.height - 16];
  context.beginPath();
  const long = length * camera.scale;
  for (const [dx, dy] of [[0, -5], [0, 0], [long, 0], [long, -5]]) context.lineTo(x + dx, y + dy);
  stroke(context, theme.ink, 1.4);
  context.fillStyle = theme.ink;
  context.font = "12px system-ui, sans-serif";
  context.fillText(si(length, "m"), x + 6, y - 6);
  if (!camera.dim3) return;
  const [ox, oy] = [theme.width - 46, theme.height - 34];
  ["x", "y", "z"].forEach((name, axis) => {
    const [dx, dy] = [24 * camera.right[axis], -24 * camera.up[axis]];
    context.beginPath();
    context.moveTo(ox, oy);
    context.lineTo(ox + dx, oy + dy);
    stroke(context, theme.ink, 1.4);
    context.fillText(name, ox + 1.35 * dx - 3, oy + 1.35 * dy + 4);
  });
}
