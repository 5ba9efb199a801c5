// An empty program, whose start time is compared with touchtrial's.
#include <string>

int main(int argc, char** argv) {
  return std::string(argv[argc - 1]).empty() ? 1 : 0;
}
