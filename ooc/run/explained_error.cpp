#include "ooc/run/explained_error.h"

#include <exception>
#include <new>

#include "libreeb/base/error.h"

namespace reeb::ooc {

void throw_explained(RunContext& run) {
  try {
    throw;
  } catch (const Error& error) {
    throw run.resumable.explain(error);
  } catch (const std::bad_alloc&) {
    throw run.resumable.explain(
        Error(ErrorKind::kResource, "out of memory", "close other programs, or allow less with --memory SIZE"));
  } catch (const std::exception&) {
    // What the program found impossible was in the state that it was given.
    if (run.resumable.checkpoint() == nullptr) throw;
    throw run.resumable.explain(
        Error(ErrorKind::kBadInput, "the checkpoint of the interrupted run is damaged", "run it again without --resume")
            .at(run.outputs[0]));
  }
}

}  // namespace reeb::ooc
