#include "bench/docs/page_section.hpp"

#include "core/errors.hpp"

namespace touchtrial::bench {

std::string with_section(const std::string& page, const std::string& name,
                         const std::string& content) {
  const std::string first = "<!-- " + name + " -->\n";
  const std::string last = "<!-- end of " + name + " -->\n";
  const std::size_t begin = page.find(first);
  const std::size_t end = begin == std::string::npos ? begin : page.find(last, begin);
  if (end == std::string::npos) {
    throw Error("the page has no part '" + name + "'; put the lines <!-- " + name +
                " --> and <!-- end of " + name + " --> where it belongs");
  }
  return page.substr(0, begin + first.size()) + "\n" + content + "\n" + page.substr(end);
}

}  // namespace touchtrial::bench
