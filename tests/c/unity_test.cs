// SPDX-License-Identifier: MIT
// The same as unreal_test.cpp by P/Invoke: usage: unity_test.exe PLATE.glb
using System;
using System.Runtime.InteropServices;

public static class UnityTest
{
    private static void Check(bool holds, string what)
    {
        if (!holds) throw new Exception(what);
    }

    public static int Main(string[] arguments)
    {
        // As interface_checks.c has them.
        Check(Marshal.SizeOf(typeof(PapillaNative.Options)) == 56, "Options");
        Check(Marshal.SizeOf(typeof(PapillaNative.Constants)) == 72, "Constants");
        Check(Marshal.SizeOf(typeof(PapillaNative.Relief)) == 32, "Relief");
        Check((int)Marshal.OffsetOf(typeof(PapillaNative.Relief), "maxM") == 24, "Relief.maxM");
        try
        {
            new PapillaScene("missing.glb");
            Check(false, "a missing file was opened");
        }
        catch (InvalidOperationException error)
        {
            Check(error.Message.Contains("missing.glb"), error.Message);
        }
        var scene = new PapillaScene(arguments[0], 1000, 3.3, arguments[0]);
        Check(scene.MaterialCount == 1 && scene.MaterialName(0) == "grain", "materials");
        Check(scene.MaterialName(1) == null, "no second material");
        Check(scene.Material(0).stiffness == 300 && double.IsInfinity(scene.Material(0).backingDepthM), "constants");
        Check(scene.Heights(0, new double[] { 0.1, 0.2 }) == null, "no relief");
        double fx = 0, fy = 0, fz = 0, x, y, z;
        scene.Reset(0.05, 0.005, -0.05);
        PapillaNative.Flag found = 0;
        for (int i = 0; i < 800; ++i) // Twice: the first force fades in.
            found = scene.Tick(0.05, Math.Max(0.005 - 2e-5 * (i % 400), -0.002), -0.05, 0, out fx, out fy, out fz);
        Check((found & PapillaNative.Flag.Contact) != 0, "contact");
        Check(Math.Abs(fy - 300 * 2.5e-3) < 1e-3 && fx == 0 && fz == 0, "force " + fy);
        Check(scene.Proxy(out x, out y, out z) == 0 && Math.Abs(y - 5.2e-4) < 1e-5, "proxy");
        scene.Dispose();
        scene.Dispose();
        try
        {
            scene.Tick(0, 0, 0, 0, out fx, out fy, out fz);
            Check(false, "a closed scene ticks");
        }
        catch (ObjectDisposedException)
        {
        }
        Console.WriteLine("passed");
        return 0;
    }
}
