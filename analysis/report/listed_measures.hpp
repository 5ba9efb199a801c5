/// \file The members of results.json with their meanings, as the data dictionary lists them.
#pragma once

#include "analysis/report/measure.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial::analysis {

struct ListedMember {
  std::string name;     ///< of a nested member, "outer.inner"
  std::string meaning;  ///< a phrase; Markdown
};

using ListedMembers = std::vector<ListedMember>;

/// An object of results.json.
struct ListedObject {
  std::string place;  ///< "methods[].accuracy[]"
  ListedMembers members;
};

[[nodiscard]] inline ListedMembers joined_members(std::vector<ListedMembers> parts) {
  ListedMembers all;
  for (ListedMembers& part : parts) std::ranges::move(part, std::back_inserter(all));
  return all;
}

/// The JSON object of a list of measures.
/// \param meanings  of every member, in order
/// \throws std::invalid_argument if the members differ from the measures'
template <typename Row>
[[nodiscard]] ListedObject listed_object(std::string place, const MeasureList<Row>& measures,
                                         ListedMembers meanings) {
  std::vector<std::string> described_names;
  for (const ListedMember& member : meanings) described_names.push_back(member.name);
  const std::vector<std::string> members = members_of(measures);
  if (described_names != members) {
    const auto [left, right] = std::ranges::mismatch(members, described_names);
    throw std::invalid_argument(place + ": the first member and meaning that differ are " +
                                (left == members.end() ? "(none)" : *left) + " and " +
                                (right == described_names.end() ? "(none)" : *right));
  }
  return {std::move(place), std::move(meanings)};
}

}  // namespace touchtrial::analysis
