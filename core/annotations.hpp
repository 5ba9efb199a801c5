/// \file Keys of an annotated schema for the tables of settings. Private to core.
#pragma once

namespace touchtrial {

inline constexpr const char* kMeaning = "x-meaning";
inline constexpr const char* kUnit = "x-unit";
inline constexpr const char* kDefaultText = "x-otherwise";
inline constexpr const char* kRange = "x-range";

}  // namespace touchtrial
