/// \file The pictures that participants choose among.
#pragma once

#include "core/plane.hpp"
#include "protocols/design/study.hpp"

#include <map>
#include <string>

namespace touchtrial::app {

/// The first image of every class by its label, those of practice too.
/// \throws FileError if an image cannot be read
[[nodiscard]] std::map<std::string, GreyImage> answer_pictures(const design::Study& study);

}  // namespace touchtrial::app
