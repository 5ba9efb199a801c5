/// \file A report in which no part is empty, with labels that contain mark-up.
#pragma once

#include "protocols/identification/analysis/page/sections.hpp"

namespace touchtrial {

/// What a user could call a texture, by mistake or not.
inline constexpr const char* kHostile = "<script>alert('x')</script> & \"b|rk\" \\_$%#{~^}";

/// Two methods and three classes, six participants.
/// \param label  of the first class
[[nodiscard]] analysis::identification::StudyReport hand_made_report(
    const std::string& label = "bark");

[[nodiscard]] analysis::Provenance hand_made_provenance();

/// An SVG file with ids, as a drawing program writes it.
[[nodiscard]] analysis::Picture hand_made_picture(const std::string& id,
                                                  const std::string& section = {});

}  // namespace touchtrial
