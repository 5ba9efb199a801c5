/// \file Conversion of units.
#pragma once

namespace touchtrial {

inline constexpr double kMmPerInch = 25.4;

}  // namespace touchtrial
