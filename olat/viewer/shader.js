// One call a frame: photo and render are two textures of it.
import { tables, fieldNamed, metricNamed } from './tables.js';

const kTriangle = `#version 300 es
void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }`;

export class Painter {
  constructor(gl, source) {
    this.gl = gl;
    this.source = source;
    this.programs = new Map();
    gl.bindVertexArray(gl.createVertexArray());
    this.nothing = this.texture(1, 1, new Uint16Array(4));
  }

  texture(width, height, data) {
    const gl = this.gl, texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    for (const [name, value] of [[gl.TEXTURE_MIN_FILTER, gl.LINEAR], [gl.TEXTURE_MAG_FILTER, gl.LINEAR],
      [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE], [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE]])
      gl.texParameteri(gl.TEXTURE_2D, name, value);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA16F, width, height, 0, gl.RGBA, gl.HALF_FLOAT, data);
    return texture;
  }

  // The program for what is on in a state, and for textures finer than the canvas.
  program(state, isMinified) {
    const view = state.view, word = name => fieldNamed(name).words.indexOf(state[name]);
    const isMap = state.mode === 'difference';
    const on = [`VIEW_${view.toUpperCase()} 1`, state.wedge && 'WEDGE 1', isMap && `METRIC ${Math.min(word('metric'), 5)}`,
      !isMap && state.mode === 'onion' && 'ONION 1', `OVERLAY ${isMap ? 0 : word('overlay')}`, !isMap && state.zebra && 'ZEBRA 1',
      state.mode === 'render' && 'RENDER 1', ['wipe', 'side'].includes(state.mode) && 'PANES 1',
      (isMap || state.zebra || state.channel === 'coverage') && 'FLAWS 1', isMinified && 'MINIFIED 1']
      .filter(Boolean).map(name => `#define ${name}\n`).join('');
    if (this.programs.has(on)) return this.programs.get(on);
    const gl = this.gl, program = gl.createProgram();
    const text = '#version 300 es\nprecision highp float;\n' + (view === 'aces' ? tables.aces : '') +
      '\n' + on + this.source;
    for (const [kind, body] of [[gl.VERTEX_SHADER, kTriangle], [gl.FRAGMENT_SHADER, text]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, body);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost()) {
      const logs = gl.getAttachedShaders(program).map(shader => gl.getShaderInfoLog(shader)).join(' ');
      throw new Error(`the shader of view ${view} does not compile: ${logs} ${gl.getProgramInfoLog(program)}`);
    }
    const made = { program, places: new Map() };
    this.programs.set(on, made);
    gl.useProgram(program);
    this.constants(made);
    return made;
  }

  place(made, name) {
    if (!made.places.has(name)) made.places.set(name, this.gl.getUniformLocation(made.program, name));
    return made.places.get(name);
  }

  constants(made) {
    const gl = this.gl, at = name => this.place(made, name);
    gl.uniform3fv(at('zone_colors'), tables.zones.flat().map(v => v / 255));
    gl.uniform3fv(at('signed_colors'), tables.signed_colors.flat());
    gl.uniform3fv(at('magma'), tables.magma.flat());
    for (const name of ['toe_color', 'shoulder_color', 'sensor_stripe', 'display_stripe']) gl.uniform3fv(at(name), tables[name]);
    for (const name of ['surround', 'grey', 'grey_zone']) gl.uniform1f(at(name), tables[name]);
    ['photo', 'render', 'flip'].forEach((name, unit) => gl.uniform1i(at(name), unit));
  }

  // `pair`: photo, render, flip (textures or null), width and height of the picture, gain, noise.
  // `window`: width and height of the canvas, pane, origin, zoom, wedge, all in its pixels.
  draw(state, pair, window) {
    const gl = this.gl, texels = Math.max(1, ...['photo', 'render', 'flip'].map(kind => (pair[kind] ? pair[kind + '_width'] : 1)));
    const made = this.program(state, window.zoom * pair.width < 0.999 * texels), at = name => this.place(made, name);
    const word = name => fieldNamed(name).words.indexOf(state[name]);
    gl.viewport(0, 0, window.width, window.height);
    gl.useProgram(made.program);
    ['photo', 'render', 'flip'].forEach((name, unit) => {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D, pair[name] ?? this.nothing);
      gl.uniform1i(at('has_' + name), pair[name] ? 1 : 0);
    });
    gl.uniform2f(at('canvas'), window.width, window.height);
    gl.uniform2f(at('size'), pair.width, pair.height);
    gl.uniform2fv(at('origin'), window.origin);
    gl.uniform1f(at('zoom'), window.zoom);
    gl.uniform1f(at('pane_width'), window.pane);
    gl.uniform1f(at('wedge'), window.wedge);
    for (const name of ['mode', 'channel']) gl.uniform1i(at(name), word(name));
    gl.uniform1f(at('split'), state.split);
    gl.uniform1f(at('onion'), state.mix);
    gl.uniform1f(at('range'), state.range > 0 ? state.range : metricNamed(state.metric).scale);
    gl.uniform1f(at('noise'), pair.noise);
    gl.uniform1f(at('exposure'), 2 ** state.ev);
    gl.uniform3fv(at('gain'), pair.gain);
    gl.uniform1fv(at('gt'), ['P', 'a', 'm', 'l', 'c', 'b'].map(name => state['gt_' + name]));
    gl.uniform2fv(at('limits'), curveLimits(state));
    // Outside of the pictures there is only the surround.
    const right = Math.min(window.pane, window.origin[0] + pair.width * window.zoom), left = Math.max(0, window.origin[0]);
    const top = Math.max(0, window.origin[1]), bottom = Math.min(window.height, window.origin[1] + pair.height * window.zoom);
    gl.disable(gl.SCISSOR_TEST);
    gl.clearColor(tables.surround, tables.surround, tables.surround, 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
    if (!state.wedge) {
      gl.enable(gl.SCISSOR_TEST);
      const end = state.mode === 'side' ? window.pane + right : right;
      gl.scissor(Math.floor(left), Math.floor(window.height - bottom), Math.max(0, Math.ceil(end - left) + 1), Math.max(0, Math.ceil(bottom - top) + 1));
    }
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }
}

// Exposed light at which the view's toe ends and its shoulder starts.
export function curveLimits(state) {
  if (state.view === 'gt') return [state.gt_m, state.gt_m + (state.gt_P - state.gt_m) * state.gt_l / state.gt_a];
  const view = tables.views.find(v => v.name === state.view);
  return [view.toe, view.shoulder];
}
