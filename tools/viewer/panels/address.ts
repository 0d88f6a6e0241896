// What is shown, in the address of the page after #: so an address can be kept or passed on.
import { element } from './page'
import { kDefaultBudget } from './state'
import type { Viewer } from './state'

const kSaveMilliseconds = 300 // after the last change

export interface State {
  threshold?: number
  coloring?: string
  budget?: number
  camera?: { turn: number; tilt: number; zoom: number; target: number[] }
  chosen?: number[] // vertices
}

const numbers = (text: string | null, size: number): number[] | undefined => {
  const list = text?.split(',').map(Number)
  return list && list.length === size && list.every(Number.isFinite) ? list : undefined
}

// Whether the part after # is about what is shown, and not a place in the page.
export const hasState = () => /^#$|[#&](t|colour|arcs|view|at)=/.test(location.hash)

// What is not valid is left out.
export function readState(viewer: Viewer): State {
  viewer.hash = location.hash
  const words = new URLSearchParams(location.hash.slice(1))
  const [threshold] = numbers(words.get('t'), 1) ?? []
  const [budget] = numbers(words.get('arcs'), 1) ?? []
  const camera = numbers(words.get('view'), 6)
  const chosen = numbers(words.get('at'), 2) ?? numbers(words.get('at'), 1)
  const coloring = words.get('colour') ?? undefined
  return {
    threshold: threshold !== undefined && threshold >= 0 ? threshold : undefined,
    coloring: coloring && ['value', 'arc', 'type'].includes(coloring) ? coloring : undefined,
    budget: budget !== undefined && Number.isInteger(budget) && budget > 0 ? budget : undefined,
    camera: camera && camera[2] > 0 ? { turn: camera[0], tilt: camera[1], zoom: camera[2], target: camera.slice(3) } : undefined,
    chosen,
  }
}

export function writeState(viewer: Viewer, { threshold, coloring, budget, camera, chosen }: State) {
  const words = new URLSearchParams()
  if (threshold !== undefined) words.set('t', String(threshold))
  if (coloring && coloring !== 'value') words.set('colour', coloring)
  if (budget !== undefined) words.set('arcs', String(budget))
  if (camera) words.set('view', [camera.turn, camera.tilt, camera.zoom, ...camera.target].map((x) => Number(x.toFixed(4))).join())
  if (chosen && chosen.length > 0) words.set('at', chosen.join())
  history.replaceState(null, '', `#${words.toString().replaceAll('%2C', ',')}`)
  viewer.hash = location.hash
}

export const fileOfAddress = () => new URLSearchParams(location.search).get('file')

// Null: a file that no address names.
export function nameFile(address: string | null) {
  if (address === fileOfAddress()) return
  const words = new URLSearchParams(location.search)
  if (address === null) words.delete('file')
  else words.set('file', address)
  const text = words.toString()
  history.replaceState(null, '', `${location.pathname}${text && `?${text}`}${location.hash}`)
}

function stateOf({ file, space }: Viewer): State | null {
  if (!file) return null
  const { session, choice, graph } = file
  const camera = space?.camera
  return {
    threshold: session.wanted,
    coloring: element<HTMLSelectElement>('coloring').value,
    budget: session.budget === kDefaultBudget ? undefined : session.budget,
    camera: camera && { turn: camera.turn ?? 0, tilt: camera.tilt ?? 0, zoom: camera.zoom, target: camera.target },
    chosen: choice?.nodes.map((node) => graph.vertex[node]),
  }
}

// An address that was changed by hand stays until it is read: `hashchange` comes later than the change.
export function saveNow(viewer: Viewer) {
  clearTimeout(viewer.saving)
  const state = stateOf(viewer)
  if (state && location.hash === viewer.hash) writeState(viewer, state)
}

// Soon: browsers limit how often an address may change.
export function saveState(viewer: Viewer) {
  clearTimeout(viewer.saving)
  viewer.saving = window.setTimeout(() => saveNow(viewer), kSaveMilliseconds)
}
