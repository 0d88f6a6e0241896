// Colours of values and kinds, from the style of the page, so that they fit light and dark.

function channels(name) {
  const hex = getComputedStyle(document.documentElement).getPropertyValue(name).trim()
  return [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16) / 255)
}

export function css(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim()
}

// A function from 0..1 to three channels: blue, grey, orange, which the colour-blind tell apart, too.
export function valueColors() {
  const stops = ['--low', '--middle', '--high'].map(channels)
  return (part) => {
    const at = Math.min(1, Math.max(0, part)) * 2
    const i = at < 1 ? 0 : 1
    return stops[i].map((c, k) => c + (stops[i + 1][k] - c) * (at - i))
  }
}

export function kindColors() {
  return { min: channels('--min'), max: channels('--max'), saddle: channels('--saddle'), isolated: channels('--isolated') }
}

export function rgb(color) {
  return `rgb(${color.map((c) => Math.round(255 * c)).join(' ')})`
}

// Calls `changed` when the page turns light or dark.
export function onThemeChange(changed) {
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', changed)
}
