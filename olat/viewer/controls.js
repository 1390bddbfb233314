// The controls beside the picture: each is a field of the state, or a button of an action.
import { tables, fieldNamed } from './tables.js';
import { numberText } from './state.js';
import { keyText } from './dialogs.js';

export const byId = id => document.getElementById(id);

export function buildControls(app) {
  const root = byId('controls');
  for (const name of ['mode', 'metric', 'view', 'match', 'channel', 'overlay']) {
    const field = fieldNamed(name), select = byId('c_' + name);
    field.words.forEach((word, i) => {
      const option = new Option(word.replace('_', ' '), word);
      option.title = field.texts?.[i] ?? '';
      select.append(option);
    });
    select.addEventListener('change', () => app.change({ [name]: select.value }));
  }
  for (const [name, list] of [['camera', app.capture.cameras], ['light', app.capture.lights]]) {
    const select = byId('c_' + name);
    list.forEach(item => select.append(new Option(item.label ? `${item.id} – ${item.label}` : item.id, item.id)));
    select.addEventListener('change', () => app.change({ [name]: select.value }));
  }
  const variants = byId('c_variant');
  app.capture.variants.forEach(id => variants.append(new Option(id, id)));
  variants.addEventListener('change', () => app.change({ variant: variants.value }));
  variants.closest('label').hidden = app.capture.variants.length < 2;
  const number = (id, name) => byId(id).addEventListener('input', event => {
    const value = Number(event.target.value), [low, high] = fieldNamed(name).range;
    if (event.target.value !== '' && value >= low && value <= high) app.change({ [name]: value });
  });
  for (const name of ['ev', 'split', 'mix', 'range']) number('c_' + name, name);
  for (const name of ['zebra', 'wedge']) byId('c_' + name).addEventListener('change', event => app.change({ [name]: event.target.checked }));
  const gt = byId('gt');
  for (const field of tables.fields.filter(f => f.view === 'gt')) {
    const label = document.createElement('label'), input = document.createElement('input'), text = document.createElement('span');
    Object.assign(input, { type: 'range', min: field.range[0], max: Math.min(field.range[1], field.name === 'gt_P' ? 10 : 3), step: 0.01, id: 'c_' + field.name });
    label.title = field.text;
    text.textContent = field.name.slice(3);
    label.append(text, input, document.createElement('output'));
    gt.append(label);
    number(input.id, field.name);
  }
  root.addEventListener('keydown', event => { if (event.key === 'Escape') byId('picture').focus(); });
  for (const button of document.querySelectorAll('button[data-action]')) {
    const action = tables.actions.find(a => a.id === button.dataset.action);
    button.title = `${action.text} (${keyText(app.keys.of(action)[0])})`;
    button.setAttribute('aria-label', action.text);
    button.addEventListener('click', () => app.run(action.id));
  }
}

export function showControls(app) {
  const { state } = app;
  for (const name of ['camera', 'light', 'variant', 'mode', 'metric', 'view', 'match', 'channel', 'overlay']) byId('c_' + name).value = state[name];
  for (const name of ['ev', 'split', 'mix', 'range', ...tables.fields.filter(f => f.view === 'gt').map(f => f.name)]) {
    const input = byId('c_' + name);
    if (document.activeElement !== input || input.type === 'range') input.value = numberText(state[name]);
    const output = input.parentElement.querySelector('output');
    if (output) output.textContent = numberText(state[name]);
  }
  for (const name of ['zebra', 'wedge']) byId('c_' + name).checked = state[name];
  byId('gt').hidden = state.view !== 'gt';
  byId('row_split').hidden = state.mode !== 'wipe';
  byId('row_mix').hidden = state.mode !== 'onion';
  byId('row_range').hidden = state.mode !== 'difference';
  for (const button of document.querySelectorAll('button[data-mode]')) button.setAttribute('aria-pressed', button.dataset.mode === state.mode);
  if (app.scoresOf && app.scoresOf !== state.metric + state.variant) app.pollScores();
}
