// Colours of values and kinds, from the style of the page, so that they fit light and dark.

export function channels(name) {
  const hex = getComputedStyle(document.documentElement).getPropertyValue(name).trim()
  return [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16) / 255)
}

export function css(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim()
}

// The stops of the colours of values, at equal distances, from indigo over magenta to orange: the colour-blind tell them
// apart, too.
export function valueStops() {
  return ['--value-0', '--value-1', '--value-2', '--value-3'].map(channels)
}

// A function from 0..1 to three channels.
export function valueColors() {
  const stops = valueStops()
  return (part) => {
    const at = Math.min(1, Math.max(0, part)) * (stops.length - 1)
    const i = Math.min(stops.length - 2, Math.floor(at))
    return stops[i].map((c, k) => c + (stops[i + 1][k] - c) * (at - i))
  }
}

// Of nodes, whose rim has the colour --rim.
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
