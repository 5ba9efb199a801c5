/// \file The words and figures of a sheet, whatever it is drawn with. Private to analysis/sheet.
#pragma once

#include "analysis/sheet/stimulus_sheet.hpp"

#include <string>
#include <vector>

namespace touchtrial::analysis {

/// A figure's name and its value for every card of a line.
struct SheetRow {
  std::string name;
  std::string unit;  ///< empty where the values have it
  std::vector<std::string> values;
};

[[nodiscard]] std::vector<SheetRow> figure_rows(const std::vector<SheetCard>& line);

/// "label, 2 of 5".
[[nodiscard]] std::string title_of(const SheetCard& card);
/// Size of the picture on the plane.
[[nodiscard]] std::string size_of(const SheetCard& card);
/// Size of the enlarged patch on the plane.
[[nodiscard]] std::string patch_of(const SheetCard& card);
/// Names the study, and says so if it is simulated.
[[nodiscard]] std::string heading_of(const StimulusSheet& sheet);

inline constexpr const char* kUnblinds =
    "This sheet unblinds: it says which code is which stimulus. Keep it with the key, away from "
    "participants and from whoever runs sessions.";

}  // namespace touchtrial::analysis
