// One open file: what was read of it, and what was asked for.
import type { End } from './reader'
import { Reader } from './reader'
import type { Source } from './source'

const kSliceMilliseconds = 8

export class Session {
  wanted = Infinity // threshold
  end: End | null = null // why reading stopped, null while it goes on or if no more is wanted
  private reading: Promise<void> | null = null
  private paused = false
  private stopped = false

  private constructor(readonly source: Source, readonly reader: Reader, public budget: number) {}

  static async open(source: Source, budget: number): Promise<Session> {
    return new Session(source, await Reader.open(source), budget)
  }

  get isReading() {
    return this.reading !== null
  }

  // Reads until the version that the threshold yields is complete. `changed` is called after each frame.
  want(threshold: number, changed: () => void): Promise<void> {
    this.wanted = threshold
    this.paused = false
    this.reading ??= this.readOn(changed).finally(() => (this.reading = null))
    return this.reading
  }

  // What was read stays, and what was wanted.
  pause() {
    this.paused = true
  }

  close() {
    this.stopped = true
    this.source.stop()
  }

  // Whether a finer version than those that were read may be needed.
  private needsMore(): boolean {
    const { graph, header, isComplete } = this.reader
    if (isComplete) return false
    if (graph.finest > header.steps) return true
    const version = graph.versionAt(this.wanted)
    return version === graph.finestOffered && !(this.wanted > graph.persistenceOf(version))
  }

  private async readOn(changed: () => void) {
    this.end = null
    let pauseAt = 0
    while (!this.stopped && !this.paused && this.needsMore()) {
      const { header, graph } = this.reader
      // The first version is shown whatever the budget.
      this.end = await this.reader.readFrame(graph.finest > header.steps ? Infinity : this.budget)
      if (this.end) break
      changed()
      // Browsers make a pause last 4 ms, so a file of many small frames must not pause after each.
      if (performance.now() < pauseAt) continue
      await new Promise((done) => setTimeout(done))
      pauseAt = performance.now() + kSliceMilliseconds
    }
    if (!this.stopped) changed()
  }
}
