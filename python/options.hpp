/// \file Options from Python as JSON text, parsed by the study file's reader. In Python, a bad
/// argument raises ValueError. Private to python.
#pragma once

#include "engine/extraction_options.hpp"
#include "engine/rendering/rendering_options.hpp"

#include <cstdint>
#include <string>

namespace touchtrial::python {

/// \param method  an object as in a study file's "methods"
/// \param seed  seed of a control
/// \throws std::invalid_argument, naming the key, if it is invalid
[[nodiscard]] engine::ExtractionOptions method_options(const std::string& method,
                                                       std::uint64_t seed);

/// \param rendering  an object as a study file's "rendering"
/// \throws std::invalid_argument, naming the key, if it is invalid
[[nodiscard]] engine::RenderingOptions rendering_options(const std::string& rendering);

}  // namespace touchtrial::python
