// XXH64 with seed 0.
import createHasher from 'xxhash-wasm'

// The checksum of these bytes, one part after the other.
export type Digest = (parts: Uint8Array[]) => bigint

export async function makeDigest(): Promise<Digest> {
  const { create64 } = await createHasher()
  return (parts) => {
    const state = create64()
    for (const part of parts) state.update(part)
    return state.digest()
  }
}
