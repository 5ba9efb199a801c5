/// \file The literature that the report's statistics follow. Source: docs/statistics.md.
#pragma once

#include <span>
#include <string_view>

namespace touchtrial::analysis {

struct Reference {
  std::string_view key;   ///< "brown2001": what sections cite
  std::string_view text;  ///< authors, year, title, journal
};

/// By key, rising.
[[nodiscard]] std::span<const Reference> report_references() noexcept;

}  // namespace touchtrial::analysis
