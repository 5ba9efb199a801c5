/// \file Which image of a class comes next. Private to protocols/design.
#pragma once

#include "core/random.hpp"
#include "protocols/design/study.hpp"

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace touchtrial {

/// Deals the images of each class and method like a pack of cards of one participant: all are used
/// before any repeats, then they are shuffled anew.
class ExemplarSupply {
 public:
  ExemplarSupply(const Study& study, int enrolment) : study_(study), enrolment_(enrolment) {}

  /// The next image of the class under the method.
  [[nodiscard]] int next(int class_index, int method);

 private:
  struct Deck {
    RandomStream random;
    std::vector<int> left;  ///< next at the back
  };

  const Study& study_;
  int enrolment_;
  std::map<std::pair<int, int>, Deck> decks_;
};

}  // namespace touchtrial
