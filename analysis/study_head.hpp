/// \file What every report says of its study, whatever the protocol.
#pragma once

#include "analysis/collection.hpp"
#include "analysis/outcomes.hpp"

#include <string>
#include <vector>

namespace touchtrial::analysis {

struct StudyHead {
  std::string study;
  std::string protocol;
  bool simulated = false;
  bool pilot = false;
  int participants = 0;  ///< whose session counts
  int trials = 0;        ///< that count
  std::vector<std::string> classes;
  Collection collection;              ///< how it was collected
  store::StudyState state{};          ///< unblinded; not closed: an interim look
  design::Registration registration;  ///< what was deposited beforehand
  std::vector<std::string> warnings;  ///< what a reader could take a number for, wrongly
};

/// Everything but the warnings.
[[nodiscard]] StudyHead head_of(const Outcomes& outcomes);

/// The JSON object of a report: the head's members, the protocol's own, then warnings, registration
/// and collection. Indented, ending with a line feed.
/// \param members  a JSON object
[[nodiscard]] std::string framed_json(const StudyHead& head, const std::string& members);

}  // namespace touchtrial::analysis
