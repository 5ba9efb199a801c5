/// \file The parts of a page of the documentation that a program writes.
#pragma once

#include <string>

namespace touchtrial::bench {

/// A Markdown page with everything between the lines <!-- NAME --> and <!-- end of NAME -->
/// replaced. \throws Error if the page lacks one of these lines, or has them in the wrong order
[[nodiscard]] std::string with_section(const std::string& page, const std::string& name,
                                       const std::string& content);

}  // namespace touchtrial::bench
