// The cost of starting any C++ program: the peer of touchtrial's start.
#include <string>

int main(int argc, char** argv) {
  return std::string(argv[argc - 1]).empty() ? 1 : 0;
}
