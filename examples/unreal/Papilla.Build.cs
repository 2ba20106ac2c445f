// SPDX-License-Identifier: MIT
// Plugins/Papilla/Source/Papilla/: this file, PapillaHaptic.h in Public/, and ThirdParty/ with include/ and lib/ of a
// Papilla that was installed by `cmake --install build/release --prefix ThirdParty`, or of the package libpapilla-dev.
using System.IO;
using UnrealBuildTool;

public class Papilla : ModuleRules
{
    public Papilla(ReadOnlyTargetRules Target) : base(Target)
    {
        Type = ModuleType.CPlusPlus;
        PCHUsage = PCHUsageMode.UseExplicitOrSharedPCHs;
        PublicDependencyModuleNames.AddRange(new[] { "Core", "CoreUObject", "Engine" });
        PublicSystemIncludePaths.Add(Path.Combine(ModuleDirectory, "ThirdParty", "include"));
        if (Target.Platform != UnrealTargetPlatform.Linux) return;
        // Loaded by FPapillaLibrary::Load("libpapilla.so.1"), not linked; staged beside the game.
        RuntimeDependencies.Add("$(BinaryOutputDir)/libpapilla.so.1",
            Path.Combine(ModuleDirectory, "ThirdParty", "lib", "libpapilla.so.1"));
    }
}
