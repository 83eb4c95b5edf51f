// Full spectrum of an orbit: forward whirl at positive frequencies, backward at negative ones.

/** Fast Fourier transform in place of a complex signal whose length is a power of two. */
export function transform(re: Float64Array, im: Float64Array): void {
  const n = re.length;
  for (let i = 1, j = 0; i < n; i++) {
    let bit = n >> 1;
    for (; j & bit; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) {
      [re[i], re[j]] = [re[j], re[i]];
      [im[i], im[j]] = [im[j], im[i]];
    }
  }
  for (let length = 2; length <= n; length <<= 1) {
    const angle = (-2 * Math.PI) / length;
    for (let start = 0; start < n; start += length) {
      for (let k = 0; k < length / 2; k++) {
        const cos = Math.cos(angle * k);
        const sin = Math.sin(angle * k);
        const a = start + k;
        const b = a + length / 2;
        const re_b = re[b] * cos - im[b] * sin;
        const im_b = re[b] * sin + im[b] * cos;
        re[b] = re[a] - re_b;
        im[b] = im[a] - im_b;
        re[a] += re_b;
        im[a] += im_b;
      }
    }
  }
}

/** Lines of a full spectrum: frequencies ascending from negative to positive (Hz), amplitudes in the motion's unit. */
export interface Spectrum {
  frequency: Float64Array;
  amplitude: Float64Array;
}

/**
 * Spectrum of y + i z, evenly sampled at `rate` (Hz), about its mean, with a Hann window. With x down the hole a
 * positive rotary speed turns y towards z, so that positive frequencies are forward. The newest power of two of the
 * samples is taken.
 */
export function fullSpectrum(y: ArrayLike<number>, z: ArrayLike<number>, rate: number): Spectrum | null {
  if (y.length < 16 || !(rate > 0)) return null;
  const n = 2 ** Math.floor(Math.log2(y.length));
  const from = y.length - n;
  const re = new Float64Array(n);
  const im = new Float64Array(n);
  let meanY = 0;
  let meanZ = 0;
  for (let i = 0; i < n; i++) {
    meanY += y[from + i] / n;
    meanZ += z[from + i] / n;
  }
  let windowSum = 0;
  for (let i = 0; i < n; i++) {
    const hann = 0.5 - 0.5 * Math.cos((2 * Math.PI * i) / n);
    windowSum += hann;
    re[i] = (y[from + i] - meanY) * hann;
    im[i] = (z[from + i] - meanZ) * hann;
  }
  transform(re, im);
  const frequency = new Float64Array(n);
  const amplitude = new Float64Array(n);
  for (let i = 0; i < n; i++) {
    const line = i - n / 2;
    const at = (line + n) % n;
    frequency[i] = (line * rate) / n;
    amplitude[i] = Math.hypot(re[at], im[at]) / windowSum;
  }
  return { frequency, amplitude };
}
