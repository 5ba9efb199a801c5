/// \file A texture label and its images.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace touchtrial::design {

/// Each image is an exemplar.
struct StudyClass {
  std::string label;
  std::vector<std::filesystem::path> images;  ///< as written in the file

  friend bool operator==(const StudyClass&, const StudyClass&) = default;
};

}  // namespace touchtrial::design
