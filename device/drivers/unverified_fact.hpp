/// \file What nobody has checked on a real device. Each driver lists its own facts, beside its code:
/// docs and the bring-up print them from there.
#pragma once

#include <string>
#include <vector>

namespace touchtrial::device {

struct UnverifiedFact {
  std::string id;                      ///< one word, unique among those of a driver
  std::string what;                    ///< a line without a full stop
  std::string question{};              ///< that a bring-up asks; empty: none
  std::vector<std::string> answers{};  ///< its possible answers, one word each
};

}  // namespace touchtrial::device
