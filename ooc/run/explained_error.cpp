#include "ooc/run/explained_error.h"

#include <new>
#include <string_view>
#include <system_error>

namespace reeb::ooc {

std::optional<Error> error_of_limit(const std::exception& error) {
  const bool is_of_tbb = std::string_view(error.what()).starts_with("pthread_");
  if (!is_of_tbb && dynamic_cast<const std::system_error*>(&error) == nullptr) return std::nullopt;
  return Error(ErrorKind::kResource, error.what(),
               "allow more memory and processes (ulimit -v, ulimit -u), or use fewer --threads");
}

void throw_explained(RunContext& run) {
  try {
    throw;
  } catch (const Error& error) {
    throw run.resumable.explain(error);
  } catch (const std::bad_alloc&) {
    throw run.resumable.explain(
        Error(ErrorKind::kResource, "out of memory", "close other programs, or allow less with --memory SIZE")
            .because(ErrorCause::kMemory));
  } catch (const std::exception& error) {
    if (const auto limit = error_of_limit(error)) throw run.resumable.explain(*limit);
    // What the program found impossible was in the state that it was given.
    if (run.resumable.checkpoint() == nullptr) throw;
    throw run.resumable.explain(
        Error(ErrorKind::kBadInput, "the checkpoint of the interrupted run is damaged", "run it again without --resume")
            .at(run.outputs[0]));
  }
}

}  // namespace reeb::ooc
