/// \file What the figures were taken on.
#pragma once

#include <string>

namespace touchtrial::bench {

struct Machine {
  std::string processor;  ///< its name and instruction set, for instance "Xeon .. (AVX-512)"
  std::string compiler;
  std::string opencv;  ///< version
  std::string date;    ///< UTC, "2026-11-20"
};

[[nodiscard]] Machine this_machine();

}  // namespace touchtrial::bench
