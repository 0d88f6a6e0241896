// The extension module reeb._reeb. What users see is made of it in reeb/*.py.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "libreeb/base/error.h"
#include "tools/python/module.h"
#include "tools/python/without_gil.h"

namespace reeb::python {

namespace py = pybind11;

namespace {

// The exception classes are Python's own (reeb/errors.py), which chooses one.
void translate(std::exception_ptr thrown) {
  const auto raise = [&](const Error& error) {
    const py::object path = py::reinterpret_steal<py::object>(
        PyUnicode_DecodeFSDefaultAndSize(error.file().data(), static_cast<py::ssize_t>(error.file().size())));
    const py::object made =
        py::module_::import("reeb.errors")
            .attr("_make")(static_cast<int>(error.kind()), static_cast<int>(error.cause()), path,
                           text_of(error.position()), text_of(error.message()), text_of(error.hint()));
    PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(made.ptr())), made.ptr());
  };
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const Error& error) {
    raise(error);
  } catch (const std::bad_alloc&) {
    raise(Error(ErrorKind::kResource, "out of memory", "close other programs, or allow less: memory=\"64M\"")
              .because(ErrorCause::kMemory));
  }
}

}  // namespace

static py::object decoded(const std::string& bytes, const char* errors) {
  return py::reinterpret_steal<py::object>(
      PyUnicode_DecodeUTF8(bytes.data(), static_cast<py::ssize_t>(bytes.size()), errors));
}

py::object text_of(const std::string& bytes) { return decoded(bytes, "backslashreplace"); }
py::object name_of(const std::string& bytes) { return decoded(bytes, "surrogateescape"); }

}  // namespace reeb::python

PYBIND11_MODULE(_reeb, module) {
  module.doc() = "The compiled part of reeb.";
  module.attr("version") = REEB_VERSION;
  pybind11::register_exception_translator(reeb::python::translate);
  reeb::python::wait_at_exit();
  reeb::python::add_runs(module);
  reeb::python::add_files(module);
  reeb::python::add_plots(module);
  reeb::python::add_online(module);
}
