// SPDX-License-Identifier: MIT
#pragma once

#include <dlfcn.h>

#include "CoreMinimal.h"

struct FPlatformProcess {
  static void* GetDllHandle(const TCHAR* name) { return dlopen(to_utf8(name).c_str(), RTLD_NOW | RTLD_LOCAL); }
  static void* GetDllExport(void* library, const TCHAR* name) { return dlsym(library, to_utf8(name).c_str()); }
};
