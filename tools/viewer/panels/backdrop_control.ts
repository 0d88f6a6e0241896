// The mesh behind the skeleton: taken from a file, shown and removed.
import { count } from '../../web/data.js'
import { fits, placed, readBackdrop } from '../drawing/backdrop'
import { boxOfGraph } from '../drawing/shapes'
import { showCounts } from './counts'
import { element, say } from './page'
import type { OpenFile, Viewer } from './state'
import { redraw } from './views'

export async function takeBackdrop(viewer: Viewer, mesh: File) {
  const { file, space } = viewer
  // Of several that are taken, the last one is shown.
  const isWanted = () => viewer.file === file && file?.wantedBackdrop === mesh
  try {
    if (!file) throw new Error('Open a .reeb file first; then a mesh can be shown behind its skeleton.')
    if (!space || !file.header.positions) throw new Error('There is no skeleton, so no mesh can be shown behind it.')
    file.wantedBackdrop = mesh
    const read = await readBackdrop(mesh)
    if (!isWanted()) return
    say(null)
    file.backdrop = read
    showBackdrop(viewer, file)
  } catch (error) {
    if (!file?.wantedBackdrop || isWanted()) say(error)
  }
}

export function removeBackdrop(viewer: Viewer, file: OpenFile) {
  file.backdrop = file.wantedBackdrop = null
  showBackdrop(viewer, file)
}

export function showBackdrop(viewer: Viewer, file: OpenFile) {
  const { backdrop, frame, graph, header } = file
  viewer.space?.picture.setBackdrop(backdrop && placed(backdrop, frame.middle, frame.scale))
  element('backdrop-name').textContent = backdrop ? `${backdrop.name}, ${count(backdrop.triangles.length / 3, 'triangle')}` : ''
  element('backdrop-warning').textContent =
    backdrop && !fits(backdrop, boxOfGraph(graph), ['x', 'y', 'z'].indexOf(header.name), header)
      ? 'Its box does not fit that of the graph: is it the right mesh?'
      : ''
  element('no-backdrop').hidden = backdrop === null
  // So that the same mesh can be taken again.
  if (!backdrop) element<HTMLInputElement>('backdrop').value = ''
  showCounts(viewer, file)
  redraw(viewer)
}
