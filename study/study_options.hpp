/// \file A method or a rendering in the format of the study file, for callers without a study.
#pragma once

#include "engine/extraction_options.hpp"
#include "engine/rendering/rendering_options.hpp"

#include <string>
#include <string_view>

namespace touchtrial::study {

/// Parses an object of a study file's "methods".
/// \param source  name of the text's origin, for errors
/// \throws StudyError with the place of a key or value that is not accepted
[[nodiscard]] engine::ExtractionOptions parse_method(std::string_view text,
                                                     const std::string& source);

/// Parses a study file's "rendering"; its device has no effect on forces.
/// \throws StudyError as parse_method
[[nodiscard]] engine::RenderingOptions parse_rendering(std::string_view text,
                                                       const std::string& source);

/// The rendering with every key explicit, as JSON.
[[nodiscard]] std::string written_rendering(const engine::RenderingOptions& rendering);

}  // namespace touchtrial::study
