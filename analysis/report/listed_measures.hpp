/// \file The members of results.json with their meanings, as the data dictionary lists them.
#pragma once

#include "analysis/report/measure.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial::analysis {

struct ListedMember {
  std::string name;     ///< of a member of an object within, "outer.inner"
  std::string meaning;  ///< a phrase; Markdown
};

/// An object of results.json.
struct ListedObject {
  std::string place;  ///< "methods[].accuracy[]"
  std::vector<ListedMember> members;
};

/// The object that a list of measures makes.
/// \param meanings  of every member, in their order
/// \throws std::invalid_argument if the members are others
template <typename Row>
[[nodiscard]] ListedObject listed_object(std::string place, const MeasureList<Row>& measures,
                                         std::vector<ListedMember> meanings) {
  std::vector<std::string> described;
  for (const ListedMember& one : meanings) described.push_back(one.name);
  const std::vector<std::string> members = members_of(measures);
  if (described != members) {
    const auto [left, right] = std::ranges::mismatch(members, described);
    throw std::invalid_argument(place + ": the member and the meaning that differ are " +
                                (left == members.end() ? "(none)" : *left) + " and " +
                                (right == described.end() ? "(none)" : *right));
  }
  return {std::move(place), std::move(meanings)};
}

}  // namespace touchtrial::analysis
