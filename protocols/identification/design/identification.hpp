/// \file Identification: a participant feels a texture and says which of the study's classes it is.
/// Source: the paper's two experiments (docs/method.md).
#pragma once

#include "protocols/design/protocol.hpp"

namespace touchtrial::design::identification {

/// Presents the study's first method alone.
[[nodiscard]] const Protocol& classification();
/// Presents all methods of the study, two or more, to each participant.
[[nodiscard]] const Protocol& comparison();

}  // namespace touchtrial::design::identification
