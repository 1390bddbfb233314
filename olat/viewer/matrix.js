// Cameras down, lights across, one cell a pair: how far photo and render are apart.
import { tables, metricNamed } from './tables.js';

// The color of a metric's value, as css: what the maps use, without the middle of their signed scale.
export function colorOf(value, metric) {
  if (value === null || value === undefined) return null;
  const row = metricNamed(metric), t = Math.min(1, Math.max(0, Math.abs(value) / row.scale));
  const at = t * (tables.magma.length - 1), low = Math.min(Math.floor(at), tables.magma.length - 2);
  const c = tables.magma[low].map((v, i) => Math.round(255 * (v + (at - low) * (tables.magma[low + 1][i] - v))));
  return `rgb(${c.join(' ')})`;
}

export class Matrix {
  constructor(canvas, note, pick) {
    Object.assign(this, { canvas, note, pick });
    canvas.addEventListener('click', event => {
      const at = this.cellAt(event);
      if (at) pick(at);
    });
    canvas.addEventListener('pointermove', event => {
      const at = this.cellAt(event);
      canvas.title = at ? this.text(at) : '';
    });
  }

  cellAt(event) {
    if (!this.shape) return null;
    const box = this.canvas.getBoundingClientRect();
    const light = Math.floor(((event.clientX - box.left) / box.width) * this.shape.lights);
    const camera = Math.floor(((event.clientY - box.top) / box.height) * this.shape.cameras);
    return light >= 0 && camera >= 0 && light < this.shape.lights && camera < this.shape.cameras ? { camera, light } : null;
  }
  text({ camera, light }) {
    const value = this.scores?.rows?.[camera]?.[light];
    const name = `${this.capture.cameras[camera].id}, ${this.capture.lights[light].id}`;
    return name + (value === null || value === undefined ? ': not compared' : `: ${this.scores.metric} ${this.scores.statistic} ${value}`);
  }

  show({ capture, scores, camera, light }) {
    Object.assign(this, { capture, scores });
    this.shape = { cameras: capture.cameras.length, lights: capture.lights.length };
    const { cameras, lights } = this.shape, canvas = this.canvas, ratio = window.devicePixelRatio || 1;
    const cell = Math.max(1, Math.floor((canvas.clientWidth * ratio) / lights)), rows = Math.max(3 * ratio, Math.min(16 * ratio, (96 * ratio) / cameras));
    canvas.width = cell * lights;
    canvas.height = Math.round(rows * cameras);
    canvas.style.height = canvas.height / ratio + 'px';
    const context = canvas.getContext('2d'), style = getComputedStyle(canvas);
    const gap = cell > 4 ? 1 : 0;
    for (let c = 0; c < cameras; ++c)
      for (let l = 0; l < lights; ++l) {
        const has = capture.photos[c][l] === '1', value = scores?.rows?.[c]?.[l];
        context.fillStyle = colorOf(value, scores?.metric) ?? (has ? style.getPropertyValue('--cell') : style.getPropertyValue('--hole'));
        context.fillRect(l * cell, Math.round(c * rows), cell - gap, Math.max(1, Math.round(rows) - (rows > 4 ? 1 : 0)));
      }
    context.strokeStyle = style.getPropertyValue('--ink');
    context.lineWidth = 2 * ratio;
    context.strokeRect(light * cell + ratio, Math.round(camera * rows) + ratio, Math.max(2, cell - 2 * ratio), Math.max(2, rows - 2 * ratio));
    const known = !capture.variants.length ? 'no renders to compare with' : scores ? `${scores.known} of ${scores.all} pairs compared` : '';
    this.note.textContent = scores?.rows ? `${scores.metric.replace('_', ' ')}, ${scores.statistic}; ${known}` : known;
    canvas.setAttribute('aria-label', `cameras by lights. ${this.text({ camera, light })}. ${this.note.textContent}`);
  }

  // The pairs that have a value, the worst first.
  worst() {
    const all = [];
    this.scores?.rows?.forEach((row, camera) => row.forEach((value, light) => {
      if (value !== null) all.push({ camera, light, value });
    }));
    return all.sort((p, q) => Math.abs(q.value) - Math.abs(p.value));
  }
}
