/// \file Identification: a participant feels a texture and names its class. Source: the paper's two
/// experiments (docs/method.md).
#pragma once

#include "study/protocol.hpp"

namespace touchtrial::study::identification {

/// The protocol that presents only the study's first method.
[[nodiscard]] const Protocol& classification();
/// The protocol that presents all of the study's methods, at least two, to each participant.
[[nodiscard]] const Protocol& comparison();

}  // namespace touchtrial::study::identification
