// The version that is shown: from what was read to the pictures.
import { kColorings } from '../drawing/picture'
import type { Coloring } from '../drawing/picture'
import { flatShape, shapeBytes, skeletonShape } from '../drawing/shapes'
import type { Shape } from '../drawing/shapes'
import { atOnce, inSlices } from '../drawing/slices'
import type { LoadedGraph, VersionContent } from '../reading/loaded_graph'
import { kindOf, lightUp } from './choice'
import { showCounts } from './counts'
import { element, say } from './page'
import { thresholdOf, viewsOf } from './state'
import type { OpenFile, Viewer } from './state'
import { redraw } from './views'

const kLayoutMilliseconds = 200 // after the last move of the slider
const coloringInput = element<HTMLSelectElement>('coloring')

interface Shapes {
  space: Shape | null
  flat: Shape
}

function* shapesOf({ graph, header, content, frame }: OpenFile): Generator<void, Shapes> {
  const finest = finestOf(graph, content)
  return {
    space: header.positions ? yield* skeletonShape(graph, frame) : null,
    flat: yield* flatShape(graph, content, finest),
  }
}

const finestOf = (graph: LoadedGraph, content: VersionContent) =>
  content.version === graph.finestOffered ? content : graph.contentOf(graph.finestOffered)

function showShapes({ space, flat }: Viewer, file: OpenFile, shapes: Shapes) {
  file.drawnRecords = file.shapeRecords
  file.shapeBytes = { space: shapes.space ? shapeBytes(shapes.space) : 0, flat: shapeBytes(shapes.flat) }
  if (shapes.space) space!.picture.setShape(shapes.space)
  flat!.picture.setShape(shapes.flat)
}

// At once, where a file has just been opened.
export function showFirst(viewer: Viewer, file: OpenFile) {
  file.shapeRecords = file.graph.records
  if (viewer.space) showShapes(viewer, file, atOnce(shapesOf(file)))
  showContent(viewer, file)
}

// Shows the version of the wanted threshold, as far as it was read.
export function refresh(viewer: Viewer, file: OpenFile) {
  const { graph, session } = file
  const version = graph.versionAt(session.wanted)
  const grown = graph.records !== file.shapeRecords
  if (!grown && file.content.version === version) return showCounts(viewer, file)
  try {
    file.content = graph.contentOf(version)
  } catch (error) {
    return say(error)
  }
  if (!grown) {
    clearTimeout(file.layoutTimer)
    file.layoutTimer = window.setTimeout(() => layout(viewer, file), kLayoutMilliseconds)
    return showContent(viewer, file)
  }
  file.shapeRecords = graph.records
  if (!viewer.space) return showContent(viewer, file)
  // The pictures stay as they are until those of more arcs are made.
  const done = (shapes: Shapes) => {
    showShapes(viewer, file, shapes)
    refresh(viewer, file)
    showContent(viewer, file)
  }
  file.stopShapes()
  file.stopShapes = inSlices(shapesOf(file), done, say)
  showCounts(viewer, file)
}

// The nodes of the version that is shown spread over the whole picture.
function layout(viewer: Viewer, file: OpenFile) {
  const { graph, content } = file
  if (!viewer.flat || file.drawnRecords !== file.shapeRecords) return // others are being made
  const done = (shape: Shape) => {
    file.shapeBytes.flat = shapeBytes(shape)
    viewer.flat!.picture.setShape(shape)
    showContent(viewer, file)
  }
  file.stopShapes()
  try {
    file.stopShapes = inSlices(flatShape(graph, content, finestOf(graph, content)), done, say)
  } catch (error) {
    say(error)
  }
}

function kindsOf(version: VersionContent): Uint8Array {
  const kinds = new Uint8Array(version.up.length)
  for (let i = 0; i < kinds.length; ++i) kinds[i] = kindOf(version, i)
  return kinds
}

// An arc has the kind of its end: a minimum, a maximum, between saddles, or both.
function typesOf(graph: LoadedGraph, kinds: Uint8Array): Uint8Array {
  const types = new Uint8Array(graph.records)
  for (let i = 0; i < types.length; ++i) {
    const [isMin, isMax] = [kinds[graph.lo[i]] === 1, kinds[graph.hi[i]] === 2]
    types[i] = isMin ? (isMax ? 4 : 1) : isMax ? 2 : 3
  }
  return types
}

export function showContent(viewer: Viewer, file: OpenFile) {
  const { content, graph } = file
  const kinds = kindsOf(content)
  const types = coloringInput.value === 'type' ? typesOf(graph, kinds) : null
  for (const { picture } of viewsOf(viewer)) picture.show(graph, content, kinds, types)
  lightUp(viewer, file)
  showCounts(viewer, file)
  const threshold = thresholdOf(file, content.version)
  for (const mark of document.querySelectorAll<SVGElement>('[data-mark]')) {
    const [, low, high] = file.marks[Number(mark.dataset.mark)].drawn
    mark.classList.toggle('below', high - low < threshold)
  }
  redraw(viewer)
}

export function colorPictures(viewer: Viewer) {
  const coloring = coloringInput.value as Coloring
  for (const { picture } of viewsOf(viewer)) picture.setColoring(kColorings.includes(coloring) ? coloring : 'value')
}

export function setColoring(viewer: Viewer) {
  colorPictures(viewer)
  if (viewer.file) showContent(viewer, viewer.file)
}
