/// \file What a measurement was taken on.
#pragma once

#include <string>

namespace touchtrial::bench {

/// The processor as Linux calls it, and its logical cores: "Xeon .., 2 logical cores". Elsewhere
/// its name is unknown.
[[nodiscard]] std::string this_processor();

}  // namespace touchtrial::bench
