#include "network/original_symbol.h"

#include <dlfcn.h>

#include <cstdio>
#include <cstdlib>

namespace grinder {

void* originalSymbol(const char* symbol) {
  void* definition = dlsym(RTLD_NEXT, symbol);
  if (!definition) {
    std::fprintf(stderr, "%s is in no library: another version of roscpp than this program was made for\n", symbol);
    std::abort();
  }
  return definition;
}

}  // namespace grinder
