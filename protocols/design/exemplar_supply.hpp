/// \file Which image of a class comes next. Private to protocols/design.
#pragma once

#include "core/random.hpp"
#include "protocols/design/study.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial::design {

/// Deals the images of each class and method like a pack of cards of one participant: all are used
/// before any repeats, then they are shuffled anew.
class ExemplarSupply {
 public:
  /// \param restart  ends the purposes of the random streams; empty in a participant's schedule
  ExemplarSupply(const Study& study, int enrolment, std::string restart = {})
      : study_(study), enrolment_(enrolment), restart_(std::move(restart)) {}

  /// The next image of the class under the method.
  [[nodiscard]] int next(int class_index, int method);

 private:
  struct Deck {
    RandomStream random;
    std::vector<int> left;  ///< next at the back
  };

  const Study& study_;
  int enrolment_;
  std::string restart_;
  std::map<std::pair<int, int>, Deck> decks_;
};

}  // namespace touchtrial::design
