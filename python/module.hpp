/// \file The parts of the native Python module. Private to python because it exposes pybind11's types.
#pragma once

#include <pybind11/pybind11.h>

namespace touchtrial::python {

/// Adds extract and evaluate.
void add_extraction(pybind11::module_& module);
/// Adds Field, force_fields and render.
void add_rendering(pybind11::module_& module);
/// Adds Study, read and simulate.
void add_studies(pybind11::module_& module);

}  // namespace touchtrial::python
