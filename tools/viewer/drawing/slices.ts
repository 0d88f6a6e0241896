// Long work in slices, so that frames are drawn in between.

const kSliceMilliseconds = 4

// Steps through `work`, which yields often, and calls `done` with its result, or `failed` with what it throws. Returns a
// function that stops it.
export function inSlices<T>(work: Generator<void, T>, done: (result: T) => void, failed: (error: unknown) => void): () => void {
  let stopped = false
  const slice = () => {
    if (stopped) return
    const end = performance.now() + kSliceMilliseconds
    try {
      for (let step = work.next(); ; step = work.next()) {
        if (step.done) return done(step.value)
        if (performance.now() > end) break
      }
    } catch (error) {
      return failed(error)
    }
    setTimeout(slice)
  }
  slice()
  return () => (stopped = true)
}

// The same at once.
export function atOnce<T>(work: Generator<void, T>): T {
  for (;;) {
    const step = work.next()
    if (step.done) return step.value
  }
}
