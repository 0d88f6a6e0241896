// The reader, for programs other than the page.
export { FormatError } from './bytes'
export { Reader } from './reader'
export { BlobSource, HttpSource, SourceError } from './source'
