/// \file Ratings: a participant feels a texture, then sees a picture, and says on one or several
/// scales how well they fit. Source: docs/rating.md.
#pragma once

#include "study/protocol.hpp"

#include <string>
#include <vector>

namespace touchtrial::study::rating {

/// A scale of the study file.
struct RatedScale {
  std::string id;  ///< a plain name, unique
  /// \name The words of the question and of the scale's ends; of the scale "fit" they may be empty:
  /// then the languages' own
  ///@{
  Translated text;
  Translated low;
  Translated high;
  ///@}
  int points = 0;  ///< 2 to kMaxPoints; 0: a line
};

inline constexpr int kMaxPoints = 11;
inline constexpr int kMaxScales = 6;

/// The study file's "rating".
struct RatingOptions {
  std::vector<RatedScale> scales{{.id = "fit", .text = {}, .low = {}, .high = {}}};
  /// Practice begins with the ends of the scale: a plane without texture, and a texture under its
  /// own picture.
  bool anchors = true;
};

/// \pre the study's protocol is this one
[[nodiscard]] const RatingOptions& options_of(const Study& study);
/// The scales in the study's language.
[[nodiscard]] std::vector<Scale> scales_of(const Study& study);

/// The protocol "rating".
[[nodiscard]] const Protocol& protocol();

}  // namespace touchtrial::study::rating
