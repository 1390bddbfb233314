#pragma once

#include <string_view>

// The page's own style and script. `info` is info.json, `planes` the URLs of its JPEGs, `rings` the directions of photographs' lights.
namespace likeness::realis {

inline constexpr std::string_view kPageLook = R"css(
.stage{display:grid;grid-template-columns:minmax(0,1fr) 240px;gap:20px;align-items:start}
#picture{display:block;width:100%;height:auto;max-height:82vh;object-fit:contain;object-position:left top;cursor:crosshair;touch-action:none}
#pad{display:block;width:100%;max-width:240px;height:auto;touch-action:none;cursor:crosshair}
#pad:focus-visible{outline:3px solid var(--mark);outline-offset:2px}
#said{min-height:3em}
@media (max-width:760px){.stage{grid-template-columns:minmax(0,1fr)}#picture{max-height:70vh}#pad{max-width:190px;margin:0 auto}}
)css";

inline constexpr std::string_view kPageScript = R"js(
const canvas = document.getElementById("picture"), pad = document.getElementById("pad"), said = document.getElementById("said");
const count = info.nplanes, jpegs = count / 3, material = info.materials[0], hasComponents = info.colorspace === "mrgb";
let light = [0, 0, 1], gl = null, program = null;

// What each term counts for: the sums that relight and OpenLIME have.
const terms = {
  ptm: ([x, y]) => [1, x, y, x * x, x * y, y * y],
  hsh: ([x, y, z]) => {
    const phi = Math.atan2(y, x), c = Math.cos(Math.min(Math.acos(z), Math.PI / 2 - 0.15)), s = Math.sqrt(c - c * c), pi = Math.PI;
    return [1 / Math.sqrt(2 * pi), Math.sqrt(6 / pi) * Math.cos(phi) * s, Math.sqrt(3 / (2 * pi)) * (2 * c - 1),
      Math.sqrt(6 / pi) * Math.sin(phi) * s, Math.sqrt(30 / pi) * Math.cos(2 * phi) * (c * c - c),
      Math.sqrt(30 / pi) * Math.cos(phi) * (2 * c - 1) * s, Math.sqrt(5 / (2 * pi)) * (1 - 6 * c + 6 * c * c),
      Math.sqrt(30 / pi) * Math.sin(phi) * (2 * c - 1) * s, Math.sqrt(30 / pi) * Math.sin(2 * phi) * (c * c - c)];
  },
  bilinear: ([x, y, z]) => {
    const n = info.resolution, out = new Array(n * n).fill(0), sum = Math.abs(x) + Math.abs(y) + Math.abs(z);
    const u = ((x + y) / sum + 1) / 2 * (n - 1), v = ((y - x) / sum + 1) / 2 * (n - 1);
    const i = Math.min(n - 2, Math.max(0, Math.floor(u))), j = Math.min(n - 2, Math.max(0, Math.floor(v)));
    out[i + n * j] = (1 - u + i) * (1 - v + j), out[i + 1 + n * j] = (u - i) * (1 - v + j);
    out[i + n * (j + 1)] = (1 - u + i) * (v - j), out[i + 1 + n * (j + 1)] = (u - i) * (v - j);
    return out;
  },
  rbf: (d) => {
    const out = [];
    for (let i = 0; i < info.lights.length; i += 3) {
      const square = d.reduce((sum, value, k) => sum + (value - info.lights[i + k]) ** 2, 0);
      out.push(Math.exp(-square / (info.sigma * info.sigma)));
    }
    const shares = (all) => { const sum = all.reduce((a, b) => a + b, 0); return all.map((w) => w / sum); };
    return shares(shares(out).map((w) => w > 0.001 ? w : 0));
  },
};

// A color is `constant` + the sum over JPEGs of a matrix times its three planes.
function weights() {
  const t = terms[info.type](light), constant = [0, 0, 0], matrices = new Float32Array(9 * jpegs);
  t.forEach((term, i) => {
    for (let c = 0; c < 3; ++c) {
      if (!hasComponents) { matrices[9 * i + 4 * c] = term; continue; }
      constant[c] += term * info.basis[3 * i + c] / 255;
      for (let p = 0; p < count; ++p)
        matrices[9 * Math.floor(p / 3) + 3 * (p % 3) + c] +=
          term * (info.basis[3 * ((p + 1) * t.length + i) + c] - 127) / material.range[p];
    }
  });
  return [constant, matrices];
}

function draw() {
  if (!gl) return;
  const [constant, matrices] = weights();
  gl.uniform3fv(gl.getUniformLocation(program, "constant"), constant);
  gl.uniformMatrix3fv(gl.getUniformLocation(program, "weight"), false, matrices);
  gl.drawArrays(gl.TRIANGLES, 0, 3);
}

// "From the upper right, 35 degrees above the picture".
function words([x, y, z]) {
  const r = Math.hypot(x, y), across = Math.round(Math.asin(z) * 180 / Math.PI);
  if (r < 0.05) return "From the camera's side.";
  const side = Math.abs(x) > 0.38 * r ? (x > 0 ? "right" : "left") : "";
  const end = Math.abs(y) > 0.38 * r ? (y > 0 ? "top" : "bottom") : "";
  return `From the ${[end, side].filter(Boolean).join(" ")}, ${across}° above the plane of the picture.`;
}

// How far the nearest photograph's light is, where that is far.
function caution(at) {
  const cosines = rings.map((ring) => ring.reduce((sum, value, k) => sum + value * at[k], 0));
  const nearest = Math.round(Math.acos(Math.min(1, Math.max(-1, ...cosines))) * 180 / Math.PI);
  return rings.length && nearest >= 25 ? ` The nearest photograph's light is ${nearest}° away.` : "";
}

function move(x, y) {
  const r = Math.max(1, Math.hypot(x, y));
  light = [x / r, y / r, 0];
  light[2] = Math.sqrt(Math.max(0, 1 - light[0] ** 2 - light[1] ** 2));
  pad.querySelector("#bulb").setAttribute("transform", `translate(${100 * light[0]} ${-100 * light[1]})`);
  said.textContent = words(light) + caution(light);
  requestAnimationFrame(draw);
}

function follow(element, place) {
  const at = (event) => { const [x, y] = place(event); move(x, y); };
  element.addEventListener("pointerdown", (event) => { element.setPointerCapture(event.pointerId); at(event); });
  element.addEventListener("pointermove", (event) => { if (event.buttons) at(event); });
}
const middle = (element, reach) => (event) => {
  const box = element.getBoundingClientRect(), half = reach(box);
  return [(event.clientX - box.left - box.width / 2) / half, -(event.clientY - box.top - box.height / 2) / half];
};
follow(pad, middle(pad, (box) => box.width * 100 / 220));
// The picture keeps its shape in its box, at the left.
follow(canvas, (event) => {
  const box = canvas.getBoundingClientRect(), scale = Math.min(box.width / info.width, box.height / info.height);
  const half = Math.min(info.width, info.height) * scale / 2;
  return [(event.clientX - box.left - info.width * scale / 2) / half, -(event.clientY - box.top - info.height * scale / 2) / half];
});
pad.addEventListener("keydown", (event) => {
  const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
  if (event.key === "Home") move(0, 0);
  else if (step) move(light[0] + 0.05 * step[0], light[1] + 0.05 * step[1]);
  else return;
  event.preventDefault();
});

async function start() {
  canvas.width = info.width, canvas.height = info.height;
  const context = canvas.getContext("webgl2", { preserveDrawingBuffer: true, antialias: false });
  if (!context) throw new Error("This page needs WebGL 2, which this browser does not have or has switched off.");
  if (Math.max(info.width, info.height) > context.getParameter(context.MAX_TEXTURE_SIZE))
    throw new Error("The picture is larger than this machine's graphics can hold.");
  const shader = (type, text) => {
    const out = context.createShader(type);
    context.shaderSource(out, "#version 300 es\nprecision highp float;\n" + text);
    context.compileShader(out);
    if (!context.getShaderParameter(out, context.COMPILE_STATUS)) throw new Error(context.getShaderInfoLog(out));
    return out;
  };
  const names = planes.map((_, i) => `plane${i}`);
  program = context.createProgram();
  context.attachShader(program, shader(context.VERTEX_SHADER,
    "void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }"));
  context.attachShader(program, shader(context.FRAGMENT_SHADER, `out vec4 shown;
    uniform vec3 constant, scale[${jpegs}], bias[${jpegs}];
    uniform mat3 weight[${jpegs}];
    ${names.map((name) => `uniform sampler2D ${name};`).join("\n")}
    void main() {
      ivec2 at = ivec2(gl_FragCoord.x, ${info.height}.0 - gl_FragCoord.y);
      vec3 color = constant;
      ${names.map((name, i) => `color += weight[${i}] * ((texelFetch(${name}, at, 0).rgb - bias[${i}]) * scale[${i}]);`).join("\n")}
      shown = vec4(clamp(color, 0.0, 1.0), 1.0);
    }`));
  context.linkProgram(program);
  if (!context.getProgramParameter(program, context.LINK_STATUS)) throw new Error(context.getProgramInfoLog(program));
  context.useProgram(program);
  context.viewport(0, 0, info.width, info.height);
  context.pixelStorei(context.UNPACK_COLORSPACE_CONVERSION_WEBGL, context.NONE);
  for (let i = 0; i < jpegs; ++i) {
    const image = new Image();
    image.src = planes[i];
    await image.decode();
    context.activeTexture(context.TEXTURE0 + i);
    context.bindTexture(context.TEXTURE_2D, context.createTexture());
    context.texImage2D(context.TEXTURE_2D, 0, context.RGB8, context.RGB, context.UNSIGNED_BYTE, image);
    for (const [name, value] of [["MIN_FILTER", "NEAREST"], ["MAG_FILTER", "NEAREST"], ["WRAP_S", "CLAMP_TO_EDGE"], ["WRAP_T", "CLAMP_TO_EDGE"]])
      context.texParameteri(context.TEXTURE_2D, context["TEXTURE_" + name], context[value]);
    context.uniform1i(context.getUniformLocation(program, names[i]), i);
  }
  context.uniform3fv(context.getUniformLocation(program, "scale"), material.scale);
  context.uniform3fv(context.getUniformLocation(program, "bias"), material.bias);
  gl = context;
}

const asked = location.hash.slice(1).split(",").map(Number);  // page.html#x,y begins with that light
move(...(asked.length === 2 && asked.every(Number.isFinite) ? asked : [0.4, 0.4]));
start().then(() => { draw(); document.body.dataset.ready = "yes"; },
  (error) => { document.getElementById("fault").textContent = error.message; document.getElementById("fault").hidden = false; });
)js";

}  // namespace likeness::realis
