/// \file Where a report's methods come from: its list of references.
#pragma once

#include <string_view>

namespace touchtrial::analysis {

/// A publication that a report may cite.
enum class Source {
  wilson,
  clopper_pearson,
  brown_cai_dasgupta,
  student,
  davison_hinkley,
  hesterberg,
  phipson_smyth,
  green_swets,
  hacker_ratcliff,
  tan_reed_durlach,
  miller,
  luce,
  townsend_landon,
  hyndman_fan,
  fagerland,
  cochran,
  holm,
  mantel_haenszel,
  robins_breslow_greenland,
  lin,
  kuhn,
  williams,
};

/// Authors, year, title and where it appeared, in UTF-8, without an address.
[[nodiscard]] std::string_view citation_of(Source source) noexcept;

}  // namespace touchtrial::analysis
