// A state as an object, and its text: the query of the page's address (olat/pair/state.h).
import { tables, fieldNamed } from './tables.js';

export function initialState() {
  return Object.fromEntries(tables.fields.map(field => [field.name, field.initial]));
}

// What is kept of a number: four decimals.
export function kept(value) {
  return Math.floor(value * 1e4 + 0.5) / 1e4;
}

export function numberText(value) {
  const text = kept(value).toFixed(4).replace(/0+$/, '').replace(/\.$/, '');
  return text === '-0' ? '0' : text;
}

function printed(state, field) {
  const value = state[field.name];
  return field.kind === 'number' ? numberText(value) : field.kind === 'flag' ? (value ? '1' : '0') : value;
}

function encoded(text) {
  return encodeURIComponent(text).replace(/[!'()*]/g, c => '%' + c.charCodeAt(0).toString(16).toUpperCase());
}

export function textOf(state) {
  const initial = initialState();
  return tables.fields
    .filter(field => printed(state, field) !== printed(initial, field))
    .map(field => field.name + '=' + encoded(printed(state, field)))
    .join('&');
}

// The same with the exposure in it also where that is 0: an address that names none is opened with one for its photo.
export function addressOf(state) {
  const text = textOf(state);
  return numberText(state.ev) === '0' ? text + (text ? '&' : '') + 'ev=0' : text;
}

// Values that cannot be used are left at their default and named in `faults`.
export function stateOf(text) {
  const state = initialState(), faults = [];
  for (const part of text.replace(/^\?/, '').split('&').filter(Boolean)) {
    const at = part.indexOf('='), name = decodeURIComponent(part.slice(0, at)), value = decodeURIComponent(part.slice(at + 1));
    const field = fieldNamed(name);
    if (!field) faults.push(name);
    else if (!assign(state, field, value)) faults.push(`${name} = ${value}`);
  }
  return { state, faults };
}

function assign(state, field, text) {
  if (field.kind === 'number') {
    const value = Number(text);
    if (text.trim() === '' || !(value >= field.range[0] && value <= field.range[1])) return false;
    state[field.name] = kept(value);
  } else if (field.kind === 'flag') {
    if (!['0', '1', 'true', 'false'].includes(text)) return false;
    state[field.name] = text === '1' || text === 'true';
  } else {
    if (field.kind === 'word' && !field.words.includes(text)) return false;
    state[field.name] = text;
  }
  return true;
}

// What a picture passes on its way to the display, and eight digits that stand for it (FNV-1a, 32 bit).
export function pipelineOf(state) {
  const shared = tables.fields.filter(field => field.shared && (!field.view || field.view === state.view));
  return 'lin_rec709_scene' + shared.map(field => `;${field.name}=${printed(state, field)}`).join('') + ';oetf=srgb';
}

export function hashOf(text) {
  let hash = 2166136261;
  for (const byte of new TextEncoder().encode(text)) hash = Math.imul(hash ^ byte, 16777619);
  return (hash >>> 0).toString(16).padStart(8, '0');
}
