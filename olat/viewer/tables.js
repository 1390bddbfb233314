// The lists that the program states once (olat/pair/tables.h): fields, metrics, views, actions, colors.
export const tables = {};

export function takeTables(from) {
  Object.assign(tables, from);
}

export function fieldNamed(name) {
  return tables.fields.find(field => field.name === name);
}

export function metricNamed(id) {
  return tables.metrics.find(metric => metric.id === id);
}
