#pragma once

namespace grinder {

/// Finds the shared library's definition of a function that the program overrides. Ends the program if there is none:
/// the override has nothing to call.
/// @param symbol its mangled name.
void* originalSymbol(const char* symbol);

}  // namespace grinder
