/// \file The parts of the native module. Private to python because it exposes pybind11's types.
#pragma once

#include <pybind11/pybind11.h>

namespace touchtrial::python {

/// extract, evaluate
void add_extraction(pybind11::module_& module);
/// Field and render
void add_rendering(pybind11::module_& module);
/// Study and simulate
void add_studies(pybind11::module_& module);

}  // namespace touchtrial::python
