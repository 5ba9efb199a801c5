/// \file Facts that have not been verified on a real device. Each driver lists its facts; docs and
///   the bring-up print them.
#pragma once

#include <string>
#include <vector>

namespace touchtrial::device {

struct UnverifiedFact {
  std::string id;                      ///< one word, unique within a driver
  std::string what;                    ///< the fact, one line without a full stop
  std::string question{};              ///< for the bring-up; empty: none
  std::vector<std::string> answers{};  ///< possible answers, one word each
};

}  // namespace touchtrial::device
