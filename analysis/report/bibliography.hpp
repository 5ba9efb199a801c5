/// \file The publications that reports cite. How each is used: docs/statistics.md.
#pragma once

#include <span>
#include <string_view>

namespace touchtrial::analysis {

enum class Source {
  benjamini_hochberg,
  brown_cai_dasgupta,
  clopper_pearson,
  cochran,
  cumming_finch,
  davison_hinkley,
  fagerland,
  fischer_whitney,
  fleming_lau,
  green_swets,
  hacker_ratcliff,
  hesterberg,
  hills_armitage,
  holm,
  hu_song,
  hyndman_fan,
  ince,
  inthout,
  kaernbach,
  kontsevich_tyler,
  kuhn,
  lan_demets,
  levitt,
  lin,
  luce,
  mantel_haenszel,
  miller,
  miller_jackknife,
  paule_mandel,
  phipson_smyth,
  prins,
  robins_breslow_greenland,
  senn,
  shrout_fleiss,
  student,
  tan_reed_durlach,
  tobin,
  townsend_landon,
  veale,
  viechtbauer,
  wagner,
  watson,
  wichmann_hill,
  wilson,
};

struct Publication {
  Source source{};
  std::string_view key;   ///< in results.json: "brown2001"
  std::string_view text;  ///< authors, year, title, journal or publisher; ASCII, without a URL
  bool is_only_in_methods = false;  ///< not in results.json
};

/// All publications in the order of Source, which is also the alphabetical order of their keys.
[[nodiscard]] std::span<const Publication> publications() noexcept;

[[nodiscard]] std::string_view citation_of(Source source) noexcept;

}  // namespace touchtrial::analysis
