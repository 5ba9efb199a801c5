/// \file Registration of all protocols of the program. A new protocol is added only here.
#pragma once

namespace touchtrial::registration {

/// Registers all protocols with every layer. Call before the first study is read. Further calls
/// have no effect. Not thread-safe.
void register_protocols();

}  // namespace touchtrial::registration
