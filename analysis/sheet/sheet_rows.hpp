/// \file The words and numbers of a sheet, common to all its forms. Private to analysis/sheet.
#pragma once

#include "analysis/sheet/stimulus_sheet.hpp"

#include <string>
#include <vector>

namespace touchtrial::analysis {

/// A number's name and its value for every card of a line.
struct SheetRow {
  std::string name;
  std::string unit;  ///< empty if the values contain it
  std::vector<std::string> values;
};

/// \param level_of  StimulusSheet::level_of
[[nodiscard]] std::vector<SheetRow> figure_rows(const std::vector<SheetCard>& line,
                                                const std::string& level_of);

/// "label, 2 of 5"
[[nodiscard]] std::string title_of(const SheetCard& card);
/// The size of the picture on the plane.
[[nodiscard]] std::string size_of(const SheetCard& card);
/// The size of the enlarged patch on the plane.
[[nodiscard]] std::string patch_of(const SheetCard& card);
/// The study's name, marked if it is simulated.
[[nodiscard]] std::string heading_of(const StimulusSheet& sheet);

inline constexpr const char* kUnblinds =
    "This sheet unblinds: it says which code is which stimulus. Keep it with the key, away from "
    "participants and from whoever runs sessions.";

}  // namespace touchtrial::analysis
