// The parts of the extension module.
#pragma once

#include <pybind11/pybind11.h>

#include <string>

namespace reeb::python {

// As Python's text, to be read: what is not UTF-8 is written as \xFF.
pybind11::object text_of(const std::string& bytes);
// The same for a name that may be passed on: what is not UTF-8 becomes what text_bytes() of the package turns back.
pybind11::object name_of(const std::string& bytes);

// compute(), segment(), defects(), and the meshes in memory that they take.
void add_runs(pybind11::module_& module);
// The classes File and Progressive: a .reeb file, and a level of it that is moved.
void add_files(pybind11::module_& module);
// Pictures of graphs.
void add_plots(pybind11::module_& module);
// The class Online.
void add_online(pybind11::module_& module);

}  // namespace reeb::python
