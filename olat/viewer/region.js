// A rectangle of the picture, and what photo and render hold in it: mean and quantiles of luminance, and of their error in
// stops.
import { floatOfHalf, flawsAt, kMasked } from './half.js';
import { plain, stopsBetween } from './side.js';
import { byId } from './controls.js';

const kRows = [['mean'], ['5 %', 0.05], ['median', 0.5], ['95 %', 0.95]], kFirst = 0.25;  // of the picture, by keyboard

// Of ascending values: the smallest that reaches the share (nearest rank, as olat/metric has it).
function quantile(sorted, share) {
  return sorted[Math.max(0, Math.ceil(share * sorted.length) - 1)];
}
function summary(values) {
  const sorted = Float64Array.from(values).sort(), mean = values.reduce((sum, v) => sum + v, 0) / values.length;
  return kRows.map(([, share]) => (share === undefined ? mean : quantile(sorted, share)));
}

// `rect`: x, y, width, height in pixels of a picture of that `size`; entries as Pictures has them, or null. Null where no
// pixel of the rectangle counts. A row for each of kRows.
export function regionStatistics({ photo, render, rect, size, gain, noise }) {
  const from = photo ?? render, sx = from.width / size.width, sy = from.height / size.height;
  const left = Math.floor(rect.x * sx), right = Math.max(left + 1, Math.min(from.width, Math.round((rect.x + rect.width) * sx)));
  const top = Math.floor(rect.y * sy), bottom = Math.max(top + 1, Math.min(from.height, Math.round((rect.y + rect.height) * sy)));
  const light = { photo: [], render: [] }, stops = [];
  const luminance = (entry, i, g) => [0.2126, 0.7152, 0.0722].reduce((sum, w, c) => sum + w * g[c] * floatOfHalf(entry.data[4 * i + c]), 0);
  for (let y = top; y < bottom; ++y)
    for (let x = left; x < right; ++x) {
      const i = y * from.width + x;
      if (photo && flawsAt(photo.data, i) & kMasked) continue;
      const p = photo ? luminance(photo, i, [1, 1, 1]) : null, r = render ? luminance(render, i, gain) : null;
      if (photo) light.photo.push(p);
      if (render) light.render.push(r);
      if (photo && render) stops.push(stopsBetween(p, r, noise));
    }
  const pixels = Math.max(light.photo.length, light.render.length);
  if (!pixels) return null;
  return { pixels, mean: Math.max(1, Math.round(1 / sx)), photo: photo && summary(light.photo), render: render && summary(light.render), stops: stops.length ? summary(stops) : null };
}

const signed = v => (v >= 0 ? '+' : '−') + Math.abs(v).toFixed(2);

export class Region {
  // `boxes`: what marks it on the left pane and on the right one.
  constructor(app, boxes) {
    Object.assign(this, { app, boxes, rect: null, found: null });
    boxes[0].addEventListener('keydown', event => this.key(event));
  }

  // From one pixel to another, both in it.
  between(a, b) {
    this.change({ x: Math.min(a.x, b.x), y: Math.min(a.y, b.y), width: Math.abs(a.x - b.x) + 1, height: Math.abs(a.y - b.y) + 1 });
  }
  // Without a pointer: about the pinned pixel or the middle; arrows do the rest.
  begin() {
    if (!this.rect) {
      const { size, pinned } = this.app.stage, at = pinned ?? { x: size.width / 2, y: size.height / 2 };
      const width = Math.max(1, Math.round(kFirst * size.width)), height = Math.max(1, Math.round(kFirst * size.height));
      this.change({ x: Math.round(at.x - width / 2), y: Math.round(at.y - height / 2), width, height });
    }
    this.place();
    this.boxes[0].focus({ preventScroll: true });
  }
  clear() {
    this.rect = this.found = null;
    this.place();
    this.show();
    this.app.tell('no region');
    byId('picture').focus();
  }
  change({ x, y, width, height }) {
    const { size } = this.app.stage, within = (v, low, high) => Math.min(high, Math.max(low, v));
    width = within(width, 1, size.width);
    height = within(height, 1, size.height);
    this.rect = { x: within(x, 0, size.width - width), y: within(y, 0, size.height - height), width, height };
    this.found = null;  // it was of another rectangle; the next frame measures
    this.untold = true;
    this.app.redraw();
  }
  key(event) {
    const by = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    if (!by || !this.rect) return;
    event.stopPropagation();
    event.preventDefault();
    const [dx, dy] = by.map(v => v * (event.ctrlKey ? 10 : 1)), { x, y, width, height } = this.rect;
    this.change(event.shiftKey ? { x, y, width: width + dx, height: height + dy } : { x: x + dx, y: y + dy, width, height });
  }

  place() {
    const { stage, state } = this.app, { origin, zoom, pane } = stage.window, ratio = stage.ratio;
    this.boxes.forEach((box, side) => {
      box.hidden = !this.rect || (side === 1 && state.mode !== 'side');
      if (box.hidden) return;
      box.style.left = (side * pane + origin[0] + this.rect.x * zoom) / ratio + 'px';
      box.style.top = (origin[1] + this.rect.y * zoom) / ratio + 'px';
      box.style.width = (this.rect.width * zoom) / ratio + 'px';
      box.style.height = (this.rect.height * zoom) / ratio + 'px';
    });
  }

  // The panel, by what the last frame holds.
  show() {
    byId('region_panel').hidden = !this.rect;
    if (!this.rect) return;
    const { stage } = this.app, { photo, render } = stage.shownEntries, held = entry => (entry?.data ? entry : null);
    const p = held(photo), r = held(render), fits = p && (!r || r.width === p.width);
    this.found = p || r ? regionStatistics({ photo: p, render: fits || !p ? r : null, rect: this.rect, size: stage.size, gain: stage.pair.gain, noise: stage.pair.noise }) : null;
    const cells = this.found ? kRows.map(([name], k) => [name, ...['photo', 'render'].map(kind => (this.found[kind] ? plain(this.found[kind][k]) : '–')), this.found.stops ? signed(this.found.stops[k]) : '–']) : [];
    const line = (texts, tag) => {
      const out = document.createElement('tr');
      out.append(...texts.map((text, i) => Object.assign(document.createElement(i && tag ? tag : 'th'), { textContent: text })));
      return out;
    };
    byId('region_table').replaceChildren(line(['luminance', 'photo', 'render', 'stops']), ...cells.map(texts => line(texts, 'td')));
    byId('region_note').textContent = this.words() + (this.found?.mean > 1 ? `; means of ${this.found.mean} × ${this.found.mean}, closer is finer` : '');
    if (!this.untold) return;
    this.untold = false;
    this.app.tell(`region ${this.words()}: ` + cells.map(([name, photo, render, stops]) => `${name} photo ${photo}, render ${render}, ${stops} stops`).join('; '));
  }
  words() {
    const { x, y, width, height } = this.rect;
    return `${width} × ${height} at ${x}, ${y}` + (this.found ? '' : ': every pixel is masked, or there is no picture');
  }

  // As a table for a spreadsheet: tabs between columns, numbers with all their digits.
  text() {
    if (!this.rect || !this.found) return null;
    const { state } = this.app, { x, y, width, height } = this.rect;
    const rows = kRows.map(([name], k) => [name, ...['photo', 'render', 'stops'].map(kind => (this.found[kind] ? String(Number(this.found[kind][k].toPrecision(6))) : ''))]);
    return [['luminance', 'photo', 'render', 'stops'], ...rows, ['region', x, y, width, height], ['pair', state.camera, state.light, state.variant]].map(row => row.join('\t')).join('\n') + '\n';
  }
}
