// What each action of the table does (olat/pair/actions.h states ids, keys and texts), and which key means which.
import { tables, fieldNamed } from './tables.js';
import { addressOf, textOf } from './state.js';
import { kAhead } from './pictures.js';

const kStored = 'likeness-keys';

// As the table writes it: [Ctrl+][Shift+]KEY; Shift only where the key itself does not tell it.
export function keyOf(event) {
  const letter = /^[a-zA-Z]$/.test(event.key), named = event.key.length > 1;
  const key = event.key === ' ' ? 'Space' : letter ? event.key.toLowerCase() : event.key;
  const shift = event.shiftKey && (letter || named || key === 'Space');
  return (event.ctrlKey || event.metaKey ? 'Ctrl+' : '') + (shift ? 'Shift+' : '') + key;
}

export class Keys {
  constructor() {
    this.changed = {};
    try { this.changed = JSON.parse(localStorage.getItem(kStored) ?? '{}'); } catch { /* private window */ }
  }
  of(action) { return (this.changed[action.id] ?? action.keys).split(' ').filter(Boolean); }
  actionOf(key) { return tables.actions.find(action => this.of(action).includes(key)); }
  // Null, or the action that has the key already.
  change(action, key) {
    const other = this.actionOf(key);
    if (other && other.id !== action.id) return other;
    this.changed[action.id] = key;
    this.keep();
    return null;
  }
  reset() {
    this.changed = {};
    this.keep();
  }
  keep() {
    try { localStorage.setItem(kStored, JSON.stringify(this.changed)); } catch { /* private window */ }
  }
}

// By id. `app`: state, change(part), capture, places and the parts of the page.
export function makeActions(app) {
  const clamp = (v, low, high) => Math.min(high, Math.max(low, v));
  const light = by => app.goto(app.place.camera, app.presentLight(app.place.light, by));
  const camera = by => app.goto(app.presentCamera(app.place.camera, by), app.place.light);
  const cycle = (name, by = 1) => {
    const { words } = fieldNamed(name);
    app.change({ [name]: words[(words.indexOf(app.state[name]) + by + words.length) % words.length] });
  };
  const mode = name => () => app.change({ mode: app.state.mode === name ? app.lastSingle : name });
  const toggle = (name, value, otherwise) => () => app.change({ [name]: app.state[name] === value ? otherwise : value });
  const ev = by => () => app.change({ ev: clamp(app.state.ev + by, -30, 30) });
  const channel = name => toggle('channel', name, 'color');
  const slide = by => () => {
    const name = app.state.mode === 'onion' ? 'mix' : 'split';
    app.change({ [name]: clamp(app.state[name] + by, 0, 1) });
  };
  return {
    light_previous: () => light(-1),
    light_next: () => light(1),
    light_back_10: () => light(-10),
    light_on_10: () => light(10),
    light_first: () => light(-1e9),
    light_last: () => light(1e9),
    camera_previous: () => camera(-1),
    camera_next: () => camera(1),
    variant_next: () => {
      const all = app.capture.variants;
      if (all.length > 1) app.change({ variant: all[(all.indexOf(app.state.variant) + 1) % all.length] });
      else app.say(all.length ? 'there is one set of renders' : 'there are no renders');
    },
    worst: () => app.gotoWorst(),
    flip: () => app.change({ mode: app.state.mode === 'photo' ? 'render' : 'photo' }),
    hold: key => app.hold(key),
    auto_flip: () => app.autoFlip(),
    wipe: mode('wipe'),
    side: mode('side'),
    onion: mode('onion'),
    difference: mode('difference'),
    split_less: slide(-0.05),
    split_more: slide(0.05),
    metric_next: () => cycle('metric'),
    metric_previous: () => cycle('metric', -1),
    ev_up_half: ev(0.5),
    ev_down_half: ev(-0.5),
    ev_up_quarter: ev(0.25),
    ev_down_quarter: ev(-0.25),
    ev_up: ev(1),
    ev_down: ev(-1),
    ev_job: () => app.change({ ev: app.capture.pipeline.ev }),
    ev_percentile: () => app.expose('percentile'),
    ev_auto: () => app.expose('average'),
    match_next: () => cycle('match'),
    view_next: () => cycle('view'),
    view_previous: () => cycle('view', -1),
    zones: toggle('overlay', 'zones', 'none'),
    wedge: () => app.change({ wedge: !app.state.wedge }),
    curve: toggle('overlay', 'curve', 'none'),
    zebra: () => app.change({ zebra: !app.state.zebra }),
    red: channel('red'),
    green: channel('green'),
    blue: channel('blue'),
    luma: channel('luma'),
    coverage: channel('coverage'),
    signed: channel('signed'),
    color: () => app.change({ channel: 'color' }),
    fit: () => app.change({ zoom: 0, x: 0.5, y: 0.5 }),
    one_to_one: () => app.change({ zoom: 1 }),
    zoom_in: () => app.stage.zoomBy(1.25),
    zoom_out: () => app.stage.zoomBy(0.8),
    pin: () => app.stage.pin(),
    region: () => app.region.begin(),
    region_copy: () => app.copy(app.region.text(), 'there is no region; Shift and drag draws one'),
    bookmark_recall: key => app.recall(key),
    bookmark_store: key => app.store(key.replace('Ctrl+', '')),
    copy_command: () => app.copy(commandOf(app)),
    save_view: () => saveView(app.state),
    panels: () => app.togglePanels(),
    help: () => app.help(),
    palette: () => app.palette(),
    close: () => app.close(),
  };
}

// The states whose pictures are likely to be asked for next, the likeliest first.
export function neighbours(app) {
  const out = [], { camera, light } = app.place, add = (c, l) => {
    if ((c !== camera || l !== light) && app.has(c, l)) out.push(app.stateAt(c, l));
  };
  for (let by = 1; by <= kAhead; ++by)
    for (const sign of [1, -1]) add(camera, app.presentLight(light, sign * by));
  for (const sign of [1, -1]) add(app.presentCamera(camera, sign), light);
  return out;
}

export function commandOf(app) {
  const quote = text => "'" + text.replaceAll("'", "'\\''") + "'";
  return `likeness olat picture ${quote(app.capture.root ?? '.')} --state ${quote(textOf(app.state))} --out picture.png`;
}

export function saveView(state) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(new Blob([JSON.stringify(Object.fromEntries(addressOf(state).split('&').filter(Boolean).map(p => p.split('=').map(decodeURIComponent))), null, 1) + '\n'], { type: 'application/json' }));
  link.download = 'view.json';
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}
