/// \file The protocols that the program knows. A new protocol is added here and nowhere else.
#pragma once

namespace touchtrial::registration {

/// Makes all protocols known to every layer. Call before the first study is read; further calls do
/// nothing. Not thread-safe.
void register_protocols();

}  // namespace touchtrial::registration
