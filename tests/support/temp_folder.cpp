#include "support/temp_folder.hpp"

#include <stdexcept>
#include <string>
#include <system_error>

#include <stdlib.h>

namespace touchtrial {

TempFolder::TempFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "touchtrial-test-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make a temporary folder");
  path_ = name;
}

TempFolder::~TempFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace touchtrial
