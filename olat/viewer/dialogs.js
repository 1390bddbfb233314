// Help and palette, both made from the table of actions.
import { tables } from './tables.js';

function element(tag, attributes = {}, ...children) {
  const out = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith('on')) out.addEventListener(name.slice(2), value);
    else out.setAttribute(name, value);
  }
  out.append(...children);
  return out;
}

const kNames = { ArrowLeft: '←', ArrowRight: '→', ArrowUp: '↑', ArrowDown: '↓', Escape: 'Esc' };

export function keyText(key) {
  return key.split(/\+(?=.)/).map(part => kNames[part] ?? (part.length === 1 ? part.toUpperCase() : part)).join(' ');
}

function keysOf(app, action) {
  const all = app.keys.of(action), shown = all.length > 3 ? [all[0], all[all.length - 1]] : all;
  return shown.flatMap((key, i) => [i && all.length > 3 ? ' to ' : i ? ' ' : '', element('kbd', {}, keyText(key))]);
}

export function showHelp(app, dialog) {
  const body = element('div', { class: 'keys' });
  const fill = () => {
    body.replaceChildren();
    for (const group of new Set(tables.actions.map(action => action.group))) {
      const rows = tables.actions.filter(action => action.group === group).map(action =>
        element('tr', {}, element('td', {}, ...keysOf(app, action)), element('td', {}, action.text),
          element('td', {}, element('button', { type: 'button', class: 'quiet', 'aria-label': `another key for: ${action.text}`, onclick: event => ask(action, event.target) }, 'change'))));
      body.append(element('section', {}, element('h3', {}, group), element('table', {}, element('tbody', {}, ...rows))));
    }
  };
  const note = element('p', { role: 'status', class: 'note' }, 'E is brighter, Shift E darker. Every key can be changed.');
  const ask = (action, button) => {
    button.textContent = 'press a key';
    app.taking = key => {
      app.taking = null;
      if (key !== 'Escape') {
        const other = app.keys.change(action, key);
        note.textContent = other ? `${keyText(key)} is taken: ${other.text}. Change that first.` : `${action.text}: ${keyText(key)}`;
      }
      fill();
    };
  };
  fill();
  const reset = element('button', { type: 'button', onclick: () => { app.keys.reset(); note.textContent = 'The keys are as they were.'; fill(); } }, 'Reset keys');
  const close = element('button', { type: 'button', onclick: () => dialog.close() }, 'Close');
  dialog.replaceChildren(element('header', {}, element('h2', {}, 'Keys'), element('span', {}, reset, close)), note, body);
  dialog.className = 'help';
  dialog.showModal();
}

export function showPalette(app, dialog) {
  const input = element('input', { type: 'search', placeholder: 'What do you want to do?', 'aria-label': 'action', role: 'combobox', 'aria-expanded': 'true', 'aria-controls': 'found', autocomplete: 'off' });
  const list = element('ul', { id: 'found', role: 'listbox', 'aria-label': 'actions' });
  let found = [], at = 0;
  const mark = () => [...list.children].forEach((item, i) => {
    item.setAttribute('aria-selected', i === at);
    if (i === at) {
      item.scrollIntoView({ block: 'nearest' });
      input.setAttribute('aria-activedescendant', item.id);
    }
  });
  const run = action => {
    dialog.close();
    app.run(action.id);
  };
  const fill = () => {
    const words = input.value.toLowerCase().split(/\s+/).filter(Boolean);
    found = tables.actions.filter(action => action.id !== 'bookmark_recall' && action.id !== 'bookmark_store' &&
      words.every(word => `${action.text} ${action.id} ${action.group}`.toLowerCase().includes(word)));
    at = 0;
    list.replaceChildren(...found.map((action, i) => element('li', { role: 'option', id: 'found' + i, onclick: () => run(action) },
      element('span', {}, action.text), element('span', {}, ...keysOf(app, action)))));
    mark();
  };
  input.addEventListener('input', fill);
  input.addEventListener('keydown', event => {
    event.stopPropagation();
    const by = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (by) {
      at = (at + by + found.length) % Math.max(1, found.length);
      mark();
      event.preventDefault();
    } else if (event.key === 'Enter' && found[at]) {
      event.preventDefault();
      run(found[at]);
    } else if (event.key === 'Escape') {
      dialog.close();
    }
  });
  fill();
  dialog.replaceChildren(input, list);
  dialog.className = 'palette';
  dialog.showModal();
  input.focus();
}
