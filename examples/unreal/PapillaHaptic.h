// SPDX-License-Identifier: MIT
// Forces of a glTF file in Unreal. Papilla.Build.cs ships libpapilla.so.1 beside the game; it is loaded when it is
// asked for, so that a game starts without it. Functions and structs: papilla/io/papilla_haptic.h.
// clang-format off
#pragma once

#include "CoreMinimal.h"
#include "HAL/PlatformProcess.h"
#include "papilla/io/papilla_haptic.h"

// Generated from papilla_haptic.h by docs/make/bindings.mjs.
#define PAPILLA_HAPTIC_FUNCTIONS(F) \
	F(uint32_t, papilla_haptic_abi, ()) \
	F(const char*, papilla_haptic_version, ()) \
	F(papilla_haptic*, papilla_haptic_open, (const char* path, const papilla_haptic_options* options, char* message, size_t message_size)) \
	F(int32_t, papilla_haptic_close, (papilla_haptic* haptic)) \
	F(int32_t, papilla_haptic_reset, (papilla_haptic* haptic, const double position[3])) \
	F(int32_t, papilla_haptic_tick, (papilla_haptic* haptic, const double position[3], double age_s, double force[3])) \
	F(int32_t, papilla_haptic_proxy, (const papilla_haptic* haptic, double position[3], double normal[3])) \
	F(int64_t, papilla_haptic_triangles, (const papilla_haptic* haptic)) \
	F(int32_t, papilla_haptic_material_count, (const papilla_haptic* haptic)) \
	F(int32_t, papilla_haptic_warning_count, (const papilla_haptic* haptic)) \
	F(const char*, papilla_haptic_material_name, (const papilla_haptic* haptic, uint32_t material)) \
	F(const char*, papilla_haptic_warning, (const papilla_haptic* haptic, uint32_t index)) \
	F(int32_t, papilla_haptic_material, (const papilla_haptic* haptic, uint32_t material, papilla_haptic_constants* constants)) \
	F(int32_t, papilla_haptic_material_relief, (const papilla_haptic* haptic, uint32_t material, papilla_haptic_relief* relief)) \
	F(int32_t, papilla_haptic_height, (const papilla_haptic* haptic, uint32_t material, const double* uv, size_t count, double* heights_m, double* gradients_m))
// End of what is generated.

/** The functions of the library; false when it is missing, lacks one, or has another interface. */
struct FPapillaLibrary
{
#define PAPILLA_DECLARE(Result, Name, Parameters) \
	Result(*Name) Parameters = nullptr; \
	static_assert(std::is_same_v<decltype(&::Name), Result(*) Parameters>, #Name " is declared otherwise");
	PAPILLA_HAPTIC_FUNCTIONS(PAPILLA_DECLARE)
#undef PAPILLA_DECLARE

	bool Load(const FString& Path)
	{
		void* const Library = FPlatformProcess::GetDllHandle(*Path);
		if (Library == nullptr)
		{
			return false;
		}
		bool bComplete = true;
#define PAPILLA_LOAD(Result, Name, Parameters) \
	Name = reinterpret_cast<Result(*) Parameters>(FPlatformProcess::GetDllExport(Library, TEXT(#Name))); \
	bComplete = bComplete && Name != nullptr;
		PAPILLA_HAPTIC_FUNCTIONS(PAPILLA_LOAD)
#undef PAPILLA_LOAD
		return bComplete && papilla_haptic_abi() == PAPILLA_HAPTIC_ABI;
	}
};

/**
 * A scene with one probe, in the frame of the actor that shows the file: centimetres, left-handed, Z up, as Interchange
 * imports it, which swaps y and z. (glTFRuntime turns the file to (-z, x, y).) Tick() is for a thread of its own.
 */
class FPapillaScene
{
public:
	explicit FPapillaScene(const FPapillaLibrary& InLibrary) : Library(InLibrary) {}
	~FPapillaScene() { Library.papilla_haptic_close(Handle); }
	FPapillaScene(const FPapillaScene&) = delete;
	FPapillaScene& operator=(const FPapillaScene&) = delete;

	/** Closes what was open; false with the reason when the file can't be felt. */
	bool Open(const FString& Path, double RateHz, double MaxForceN, FString& OutReason)
	{
		papilla_haptic_options Options = PAPILLA_HAPTIC_OPTIONS_INIT;
		Options.rate_hz = RateHz;
		Options.max_force_n = MaxForceN;
		char Message[512] = "";
		Library.papilla_haptic_close(Handle);
		Handle = Library.papilla_haptic_open(TCHAR_TO_UTF8(*Path), &Options, Message, sizeof Message);
		OutReason = UTF8_TO_TCHAR(Message);
		return Handle != nullptr;
	}

	/** The force on the hand in newtons; flags of papilla_haptic_flag, or an error below 0. */
	int32 Tick(const FVector& PositionCm, double AgeSeconds, FVector& OutForceN)
	{
		double At[3], Force[3];
		ToFile(PositionCm, At);
		const int32 Found = Library.papilla_haptic_tick(Handle, At, AgeSeconds, Force);
		OutForceN = FVector(Force[0], Force[2], Force[1]);
		return Found;
	}

	void Reset(const FVector& PositionCm)
	{
		double At[3];
		ToFile(PositionCm, At);
		Library.papilla_haptic_reset(Handle, At);
	}

	/** Where to draw the hand; the material that holds it, or PAPILLA_HAPTIC_NONE. */
	int32 Proxy(FVector& OutPositionCm) const
	{
		double At[3];
		const int32 Material = Library.papilla_haptic_proxy(Handle, At, nullptr);
		OutPositionCm = FVector(100 * At[0], 100 * At[2], 100 * At[1]);
		return Material;
	}

private:
	static void ToFile(const FVector& Cm, double (&At)[3])
	{
		At[0] = Cm.X / 100;
		At[1] = Cm.Z / 100;
		At[2] = Cm.Y / 100;
	}

	const FPapillaLibrary& Library;
	papilla_haptic* Handle = nullptr;
};
