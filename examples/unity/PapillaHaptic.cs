// SPDX-License-Identifier: MIT
// Forces of a glTF file in Unity: this file and libpapilla.so.1 as Assets/Plugins/x86_64/libpapilla.so. The native
// functions and structs are described in papilla/io/papilla_haptic.h; PapillaScene is the way to use them.
// Without Unity the file is plain C# (csc, mcs).
using System;
using System.Runtime.InteropServices;
using System.Text;

public static class PapillaNative
{
    // Generated from papilla_haptic.h by docs/make/bindings.mjs.
    public const int Abi = 1;
    public const int MostOpen = 256;

    public enum Error
    {
        None = -1,
        BadHandle = -2,
        BadArgument = -3,
    }

    public enum Flag
    {
        Contact = 1,
        Sliding = 2,
        Fault = 4,
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct Options
    {
        public ulong structSize;
        public double rateHz;
        public double maxForceN;
        public double probeRadiusM;
        public double feltDepthM;
        public IntPtr device;
        public IntPtr tags;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct Constants
    {
        public ulong structSize;
        public double stiffness;
        public double damping;
        public double staticFriction;
        public double dynamicFriction;
        public double stribeckVelocity;
        public double backingStiffness;
        public double backingDepthM;
        public double maxStiffness;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct Relief
    {
        public ulong structSize;
        public uint width;
        public uint height;
        public double minM;
        public double maxM;
    }

    [DllImport("papilla", CallingConvention = CallingConvention.Cdecl)]
    public static extern uint papilla_haptic_abi();

    [DllImport("papilla", CallingConvention = CallingConvention.Cdecl)]
    public static extern IntPtr papilla_haptic_version();

    [DllImport("papilla", CallingConvention = CallingConvention.Cdecl)]
    public static extern IntPtr papilla_haptic_open(byte[] path, ref Options options, [Out] byte[] message, UIntPtr messageSize);

    [DllImport("papilla", CallingConvention = CallingConvention.Cdecl)]
    public static extern int papilla_haptic_close(IntPtr haptic);

    [DllImport("papilla", CallingConvention = CallingConvention.Cdecl)]
    public static extern int papilla_haptic_reset(IntPtr haptic, [In] double[] position);

    [DllImport("papilla", CallingConvention = CallingConvention.Cdecl)]
    public static extern int papilla_haptic_tick(IntPtr haptic, [In] double[] position, double ageS, [Out] double[] force);

    [DllImport("papilla", CallingConvention = CallingConvention.Cdecl)]
    public static extern int papilla_haptic_proxy(IntPtr haptic, [Out] double[] position, [Out] double[] normal);

    [DllImport("papilla", CallingConvention = CallingConvention.Cdecl)]
    public static extern long papilla_haptic_triangles(IntPtr haptic);

    [DllImport("papilla", CallingConvention = CallingConvention.Cdecl)]
    public static extern int papilla_haptic_material_count(IntPtr haptic);

    [DllImport("papilla", CallingConvention = CallingConvention.Cdecl)]
    public static extern int papilla_haptic_warning_count(IntPtr haptic);

    [DllImport("papilla", CallingConvention = CallingConvention.Cdecl)]
    public static extern IntPtr papilla_haptic_material_name(IntPtr haptic, uint material);

    [DllImport("papilla", CallingConvention = CallingConvention.Cdecl)]
    public static extern IntPtr papilla_haptic_warning(IntPtr haptic, uint index);

    [DllImport("papilla", CallingConvention = CallingConvention.Cdecl)]
    public static extern int papilla_haptic_material(IntPtr haptic, uint material, ref Constants constants);

    [DllImport("papilla", CallingConvention = CallingConvention.Cdecl)]
    public static extern int papilla_haptic_material_relief(IntPtr haptic, uint material, ref Relief relief);

    [DllImport("papilla", CallingConvention = CallingConvention.Cdecl)]
    public static extern int papilla_haptic_height(IntPtr haptic, uint material, [In] double[] uv, UIntPtr count, [Out] double[] heightsM, [Out] double[] gradientsM);
    // End of what is generated.
}

/// A scene with one probe. Positions are in metres in the frame of the file; ToUnity and FromUnity convert.
/// Tick allocates nothing; call it at the given rate from a thread of its own.
public sealed class PapillaScene : IDisposable
{
    private IntPtr handle;
    private readonly double[] at = new double[3], force = new double[3], normal = new double[3];

    /// Throws InvalidOperationException with the library's line when the file can't be felt.
    public PapillaScene(string path, double rateHz = 1000, double maxForceN = 3.3, string tags = null)
    {
        if (PapillaNative.papilla_haptic_abi() != PapillaNative.Abi)
            throw new InvalidOperationException("libpapilla.so has interface " + PapillaNative.papilla_haptic_abi() +
                                                ", not " + PapillaNative.Abi);
        var options = new PapillaNative.Options();
        options.structSize = (ulong)Marshal.SizeOf(options);
        options.rateHz = rateHz;
        options.maxForceN = maxForceN;
        var message = new byte[512];
        GCHandle pinned = default(GCHandle);
        try
        {
            if (tags != null)
            {
                pinned = GCHandle.Alloc(ToC(tags), GCHandleType.Pinned);
                options.tags = pinned.AddrOfPinnedObject();
            }
            handle = PapillaNative.papilla_haptic_open(ToC(path), ref options, message, (UIntPtr)(uint)message.Length);
        }
        finally
        {
            if (pinned.IsAllocated) pinned.Free();
        }
        if (handle == IntPtr.Zero) throw new InvalidOperationException(FromC(message));
    }

    ~PapillaScene() { Dispose(); }

    public void Dispose()
    {
        PapillaNative.papilla_haptic_close(handle);
        handle = IntPtr.Zero;
        GC.SuppressFinalize(this);
    }

    /// The force on the hand, in newtons in the frame of the file, of the newest position, ageS seconds old.
    public PapillaNative.Flag Tick(double x, double y, double z, double ageS, out double fx, out double fy, out double fz)
    {
        Set(x, y, z);
        int found = PapillaNative.papilla_haptic_tick(handle, at, ageS, force);
        fx = force[0];
        fy = force[1];
        fz = force[2];
        if (found < 0) throw new ObjectDisposedException("PapillaScene");
        return (PapillaNative.Flag)found;
    }

    /// Puts the probe there without contact on the way, and clears a fault.
    public void Reset(double x, double y, double z)
    {
        Set(x, y, z);
        PapillaNative.papilla_haptic_reset(handle, at);
    }

    /// Where to draw the hand, and the material that holds it; -1 without contact.
    public int Proxy(out double x, out double y, out double z)
    {
        int material = PapillaNative.papilla_haptic_proxy(handle, at, normal);
        x = at[0];
        y = at[1];
        z = at[2];
        return material;
    }

    public int MaterialCount { get { return PapillaNative.papilla_haptic_material_count(handle); } }

    public string MaterialName(uint material)
    {
        return FromC(PapillaNative.papilla_haptic_material_name(handle, material));
    }

    public PapillaNative.Constants Material(uint material)
    {
        var constants = new PapillaNative.Constants();
        constants.structSize = (ulong)Marshal.SizeOf(constants);
        if (PapillaNative.papilla_haptic_material(handle, material, ref constants) != 0)
            throw new ArgumentOutOfRangeException("material");
        return constants;
    }

    /// Heights in metres at texture coordinates u0, v0, u1, v1, ... of the file; null where the material has no relief.
    public double[] Heights(uint material, double[] uv)
    {
        var heights = new double[uv.Length / 2];
        int found = PapillaNative.papilla_haptic_height(handle, material, uv, (UIntPtr)(uint)heights.Length, heights, null);
        return found == 0 ? heights : null;
    }

    private void Set(double x, double y, double z)
    {
        at[0] = x;
        at[1] = y;
        at[2] = z;
    }

    private static byte[] ToC(string text) { return Encoding.UTF8.GetBytes(text + "\0"); }

    private static string FromC(byte[] text) { return Encoding.UTF8.GetString(text, 0, Array.IndexOf(text, (byte)0)); }

    private static string FromC(IntPtr text)
    {
        if (text == IntPtr.Zero) return null;
        int length = 0;
        while (Marshal.ReadByte(text, length) != 0) ++length;
        var bytes = new byte[length];
        Marshal.Copy(text, bytes, 0, length);
        return Encoding.UTF8.GetString(bytes);
    }

#if UNITY_5_3_OR_NEWER
    /// glTFast and UnityGLTF negate x: glTF is right-handed, Unity is not.
    public static UnityEngine.Vector3 ToUnity(double x, double y, double z)
    {
        return new UnityEngine.Vector3(-(float)x, (float)y, (float)z);
    }

    /// A position in the frame of the imported object, of scale 1.
    public static void FromUnity(UnityEngine.Vector3 at, out double x, out double y, out double z)
    {
        x = -at.x;
        y = at.y;
        z = at.z;
    }
#endif
}
