#include "python/options.hpp"

#include "core/errors.hpp"
#include "protocols/design/study_sections.hpp"

#include <stdexcept>

namespace touchtrial::python {
namespace {

/// In Python, a bad argument is a ValueError.
template <typename Read>
auto read_argument(const std::string& text, const std::string& argument, Read read) {
  try {
    return read(parse_strict_json(text, argument));
  } catch (const StudyError& error) {
    throw std::invalid_argument(error.what());
  }
}

}  // namespace

engine::ExtractionOptions method_options(const std::string& method, std::uint64_t seed) {
  engine::ExtractionOptions options = read_argument(
      method, "method", [](const JsonValue& place) { return design::read_method(place); });
  options.control_seed = seed;
  return options;
}

engine::RenderingOptions rendering_options(const std::string& rendering) {
  return read_argument(rendering, "rendering", [](const JsonValue& place) {
    std::string device;  // has no effect on forces
    return design::read_rendering(place, device);
  });
}

}  // namespace touchtrial::python
