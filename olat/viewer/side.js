// The right side: what is under the probe, how light is spread, and where the files come from.
import { tables } from './tables.js';
import { flawsAt, kMasked, luminanceAt } from './half.js';

const kNumerals = ['0', 'I', 'II', 'III', 'IV', 'V', 'VI', 'VII', 'VIII', 'IX', 'X', 'XI', 'XII', 'XIII', 'XIV', 'XV', 'XVI'];

export function zoneNumeral(index) {
  return kNumerals[index];
}

function cell(text, tag = 'td') {
  const element = document.createElement(tag);
  element.textContent = text;
  return element;
}
function row(...cells) {
  const element = document.createElement('tr');
  cells.forEach((text, i) => element.append(cell(text, i === 0 ? 'th' : 'td')));
  return element;
}
export function plain(value) {
  if (!Number.isFinite(value)) return '–';
  const size = Math.abs(value);
  return size >= 100 ? value.toFixed(0) : size >= 1 ? value.toFixed(2) : size >= 1e-3 || size === 0 ? value.toFixed(4) : value.toExponential(1);
}

// The metric "stops" of one value (olat/metric/formulas.h).
export function stopsBetween(photo, render, noise) {
  return Math.log2(Math.max(photo, 0) + noise) - Math.log2(Math.max(render, 0) + noise);
}

export function showProbe(table, values, ev) {
  table.replaceChildren();
  if (!values) {
    table.append(row('Point at the picture, or pin with P'));
    return;
  }
  const head = document.createElement('tr');
  for (const text of [`${values.x}, ${values.y}`, 'red', 'green', 'blue', 'stops']) head.append(cell(text, 'th'));
  table.append(head);
  const stops = c => {
    const y = 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
    return y > 0 ? (Math.log2(y / tables.grey) + ev).toFixed(2) : 'black';
  };
  for (const kind of ['photo', 'render']) {
    if (values[kind]) table.append(row(kind, ...values[kind].map(plain), stops(values[kind])));
    else table.append(row(kind, '–', '–', '–', '–'));
  }
  if (values.photo && values.render) {
    table.append(row('log₂ ratio', ...values.photo.map((p, c) => stopsBetween(p, values.render[c], values.noise).toFixed(2)), ''));
  }
  const flaws = [[1, 'clipped'], [2, 'black'], [4, 'not finite'], [8, 'masked']].filter(([bit]) => values.flaws & bit).map(([, name]) => name);
  const remarks = [values.mean > 1 ? `mean of ${values.mean} × ${values.mean} pixels` : '', flaws.join(', ')].filter(Boolean).join('; ');
  if (remarks) {
    const note = document.createElement('tr'), text = cell(remarks);
    text.colSpan = 5;
    note.append(text);
    table.append(note);
  }
}

// Shares of pixels by stops about middle grey, 4 bins a stop, from -10 to +8 after exposure.
const kLow = -10, kHigh = 8, kBins = 4 * (kHigh - kLow);

export function binsOf(entry, ev, gain = [1, 1, 1], mask = null) {
  const bins = new Float64Array(kBins), weight = 0.2126 * gain[0] + 0.7152 * gain[1] + 0.0722 * gain[2];
  let count = 0;
  const total = entry.width * entry.height, step = Math.max(1, Math.floor(total / 65536));
  for (let i = 0; i < total; i += step) {
    if (mask && flawsAt(mask, i) & kMasked) continue;
    ++count;
    const y = luminanceAt(entry.data, i) * weight;
    if (y > 0) ++bins[Math.min(kBins - 1, Math.max(0, Math.floor(4 * (Math.log2(y / tables.grey) + ev - kLow))))];
  }
  return bins.map(v => v / Math.max(1, count));
}

export function showHistogram(svg, photo, render) {
  const top = Math.max(0.01, ...(photo ?? []), ...(render ?? []));
  const path = bins => 'M0 60' + [...bins].map((v, i) => `V${(60 - (56 * v) / top).toFixed(2)}H${i + 1}`).join('') + 'V60Z';
  svg.querySelector('.photo').setAttribute('d', photo ? path(photo) : '');
  svg.querySelector('.render').setAttribute('d', render ? path(render) : '');
  const mean = bins => bins ? [...bins].reduce((sum, v, i) => sum + v * (kLow + (i + 0.5) / 4), 0) / Math.max(1e-9, [...bins].reduce((a, b) => a + b, 0)) : null;
  const text = [['photo', photo], ['render', render]].filter(([, bins]) => bins).map(([name, bins]) => `${name} ${mean(bins).toFixed(1)} stops from middle grey on average`);
  svg.setAttribute('aria-label', 'histogram in stops: ' + (text.join(', ') || 'nothing to show'));
}

export function showProvenance(list, frame) {
  list.replaceChildren();
  const add = (name, value) => {
    if (value === undefined || value === null || value === '') return;
    list.append(cell(name, 'dt'), cell(String(value), 'dd'));
  };
  if (!frame) return;
  add('photo', frame.photo ?? 'none');
  add('render', frame.render ?? 'none');
  if (frame.transfer) add('encoding', `${frame.transfer}, ${frame.primaries}`);
  if (frame.gain !== undefined && frame.gain !== 1) add('gain', plain(frame.gain));
  if (frame.exposure_s) add('exposure', [`${plain(frame.exposure_s)} s`, frame.f_number && `f/${frame.f_number}`, frame.iso && `ISO ${frame.iso}`].filter(Boolean).join(', '));
  if (frame.intensity?.some(v => v !== 1)) add('light', frame.intensity.map(plain).join(' '));
  add('calibrated by', frame.calibrated_by);
  if (frame.sha256) add('sha256', frame.sha256.slice(0, 16) + '…');
}

// Labels of the wedge: zone, stops, and the value that came out of exposure, view and display curve.
export function showWedge(root, stage, ev) {
  root.hidden = !stage.window.wedge;
  if (root.hidden) return;
  root.style.bottom = 0;
  root.style.height = stage.window.wedge / stage.ratio + 'px';
  const y = stage.window.height - Math.ceil(stage.window.wedge / 2);
  const line = stage.read(0, y, stage.window.width, 1);
  root.replaceChildren(...kNumerals.map((numeral, zone) => {
    const at = Math.floor(((zone + 0.5) * stage.window.width) / 17), value = line[4 * at + 1], label = document.createElement('span');
    const stops = zone - tables.grey_zone, ev = (stops > 0 ? '+' : '') + stops;
    label.textContent = numeral;
    label.append(document.createElement('br'), ev, document.createElement('br'), String(value));
    label.style.color = value > 110 ? '#000' : '#fff';
    label.title = `zone ${numeral}: light of ${ev} EV, shown as code ${value}`;
    return label;
  }));
}

