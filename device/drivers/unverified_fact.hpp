/// \file Facts that were not verified on a real device. Each driver lists its own; docs and the
///   bring-up print them.
#pragma once

#include <string>
#include <vector>

namespace touchtrial::device {

struct UnverifiedFact {
  std::string id;                      ///< one word, unique among those of a driver
  std::string what;                    ///< a line without a full stop
  std::string question{};              ///< asked in a bring-up; empty: none
  std::vector<std::string> answers{};  ///< its possible answers, one word each
};

}  // namespace touchtrial::device
