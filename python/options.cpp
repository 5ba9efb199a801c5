#include "python/options.hpp"

#include "core/errors.hpp"
#include "study/study_options.hpp"

#include <stdexcept>

namespace touchtrial::python {

engine::ExtractionOptions method_options(const std::string& method, std::uint64_t seed) {
  try {
    engine::ExtractionOptions options = study::parse_method(method, "method");
    options.control_seed = seed;
    return options;
  } catch (const StudyError& error) {
    throw std::invalid_argument(error.what());
  }
}

engine::RenderingOptions rendering_options(const std::string& rendering) {
  try {
    return study::parse_rendering(rendering, "rendering");
  } catch (const StudyError& error) {
    throw std::invalid_argument(error.what());
  }
}

}  // namespace touchtrial::python
