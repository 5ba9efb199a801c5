/// \file The worked example of docs/add-a-protocol.md: was there a texture, or a smooth wall?
#pragma once

namespace touchtrial::example {

/// Makes the protocol "presence" known to all layers.
void register_presence();

}  // namespace touchtrial::example
