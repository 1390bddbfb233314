// Half floats as JavaScript's numbers.
const floatOf = new Float32Array(65536);
for (let bits = 0; bits < 65536; ++bits) {
  const sign = bits & 0x8000 ? -1 : 1, exponent = (bits >> 10) & 31, fraction = bits & 1023;
  floatOf[bits] = exponent === 0 ? sign * fraction * 2 ** -24
    : exponent === 31 ? (fraction ? NaN : sign * Infinity)
    : sign * (1 + fraction / 1024) * 2 ** (exponent - 15);
}

export function floatOfHalf(bits) {
  return floatOf[bits];
}

export function luminanceAt(data, i) {
  return 0.2126 * floatOf[data[4 * i]] + 0.7152 * floatOf[data[4 * i + 1]] + 0.0722 * floatOf[data[4 * i + 2]];
}

export const kMasked = 8, kClipped = 1;

export function flawsAt(data, i) {
  return floatOf[data[4 * i + 3]] | 0;
}
