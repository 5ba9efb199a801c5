/// \file Conversion factors between units.
#pragma once

namespace touchtrial {

inline constexpr double kMmPerInch = 25.4;

}  // namespace touchtrial
