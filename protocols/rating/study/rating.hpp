/// \file The protocol "rating": a participant feels a texture, then sees a picture, and rates how
/// well they fit on one or several scales. Source: docs/rating.md.
#pragma once

#include "study/protocol.hpp"

#include <string>
#include <vector>

namespace touchtrial::study::rating {

/// A rating scale defined in the study file.
struct RatedScale {
  std::string id;  ///< a plain name, unique
  /// \name Texts of the question and of the scale's ends, by language. For the scale "fit", empty
  /// texts default to the texts of the language file.
  ///@{
  Translated text;
  Translated low;
  Translated high;
  ///@}
  int points = 0;  ///< 2 to kMaxPoints; 0: a line
};

inline constexpr int kMaxPoints = 11;
inline constexpr int kMaxScales = 6;

/// The section "rating" of the study file.
struct RatingOptions {
  std::vector<RatedScale> scales{{.id = "fit", .text = {}, .low = {}, .high = {}}};
  /// Whether practice begins with examples of the scale's ends: a plane without texture, and a
  /// texture with its own picture.
  bool anchors = true;
};

/// \pre the study's protocol is "rating"
[[nodiscard]] const RatingOptions& options_of(const Study& study);
/// The scales in the study's language.
[[nodiscard]] std::vector<Scale> scales_of(const Study& study);

/// The protocol "rating".
[[nodiscard]] const Protocol& protocol();

}  // namespace touchtrial::study::rating
