/// \file Rows of the derived tables as values, in the order of the columns of tables.hpp: what
/// every database that keeps them writes and reads.
#pragma once

#include "protocols/store/study_store.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace touchtrial::store {

/// A value of one column; nothing stands for NULL.
using Cell = std::variant<std::monostate, std::int64_t, double, std::string>;
using Cells = std::vector<Cell>;

/// How states are written, in the order of the enumerators.
inline constexpr std::array<std::string_view, 3> kSessionStates = {"open", "completed", "stopped"};
inline constexpr std::array<std::string_view, 5> kTrialStates = {
    "presented", "answered", "timed-out", "interrupted", "voided"};

/// When a row of sessions has a value in own_session.
enum class OwnNumber { if_other, always };

[[nodiscard]] Cells session_cells(const SessionRow& row, OwnNumber own = OwnNumber::if_other);
[[nodiscard]] Cells trial_cells(const TrialRow& row);
/// \pre the trial has a response
[[nodiscard]] Cells response_cells(const TrialRow& row);

/// \throws EventFault if there is a value that no event gives rise to
[[nodiscard]] SessionRow session_row(std::span<const Cell> cells);
/// \param cells  of a row of trials, then those of responses; without a response, these are empty
/// \throws the same
[[nodiscard]] TrialRow trial_row(std::span<const Cell> cells);

}  // namespace touchtrial::store
