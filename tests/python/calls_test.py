# SPDX-License-Identifier: MIT
"""Long calls: the GIL, progress, cancelling, Ctrl-C."""
import os
import signal
import threading
import unittest

import numpy as np
import papilla
import shapes


def long_mesh():
    return papilla.mesh(*shapes.bumps(160, 160))


class CallsTest(unittest.TestCase):
    def test_other_threads_run_meanwhile(self):
        mesh = long_mesh()
        steps, is_running, has_ended = [], threading.Event(), threading.Event()

        def count():
            while not has_ended.is_set():
                if is_running.is_set():
                    steps.append(1)
                has_ended.wait(1e-4)

        counter = threading.Thread(target=count)
        counter.start()
        seen = []

        def progress(stage, fraction):
            is_running.set()
            seen.append(len(steps))

        papilla.simplify(mesh, tolerance_mm=0.05, progress=progress)
        has_ended.set()
        counter.join()
        self.assertGreater(seen[-1], 0, "the other thread did nothing between the first and the last report")

    def test_calls_of_several_threads(self):
        V, F = shapes.cap(20, 20)
        results = [None] * 4

        def work(i):
            results[i] = papilla.parameterize(V, F, method="best", charts="keep").flattening.uv.values.copy()

        threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for values in results[1:]:
            np.testing.assert_array_equal(values, results[0])

    def test_progress_rises_to_the_end(self):
        seen = []
        papilla.segment_charts(long_mesh(), progress=lambda stage, fraction: seen.append((stage, fraction)))
        self.assertTrue(seen)
        fractions = [fraction for _, fraction in seen]
        self.assertTrue(all(isinstance(stage, str) and stage for stage, _ in seen))
        self.assertTrue(all(0 <= fraction <= 1 for fraction in fractions))

    def test_returning_false_cancels(self):
        calls = []

        def stop(stage, fraction):
            calls.append(fraction)
            return False

        with self.assertRaises(papilla.Cancelled):
            papilla.segment_charts(long_mesh(), progress=stop)
        self.assertEqual(len(calls), 1)

    def test_what_the_callback_raises_comes_out(self):
        def broken(stage, fraction):
            raise KeyError("mine")

        with self.assertRaisesRegex(KeyError, "mine"):
            papilla.segment_charts(long_mesh(), progress=broken)

    def test_ctrl_c(self):
        fractions = []

        def interrupt(stage, fraction):
            if not fractions:
                os.kill(os.getpid(), signal.SIGINT)
            fractions.append(fraction)

        # An hour of work: only an interruption ends this test.
        with self.assertRaises(KeyboardInterrupt):
            papilla.evaluate_stability(3600, progress=interrupt)
        self.assertLess(max(fractions), 0.5)

    def test_a_handler_of_signals_that_does_not_raise_goes_on(self):
        handled = []
        before = signal.signal(signal.SIGINT, lambda *_: handled.append(1))
        try:
            sent = []

            def send(stage, fraction):
                if not sent:
                    sent.append(os.kill(os.getpid(), signal.SIGINT))

            result = papilla.segment_charts(long_mesh(), progress=send)
        finally:
            signal.signal(signal.SIGINT, before)
        self.assertEqual(handled, [1])
        self.assertGreater(result.charts.count, 0)

    def test_threads_do_not_change_results(self):
        V, F = shapes.cap(30, 30)
        papilla.set_threads(1)
        one = papilla.parameterize(V, F, method="best").flattening.uv.values.copy()
        papilla.set_threads(0)
        np.testing.assert_array_equal(papilla.parameterize(V, F, method="best").flattening.uv.values, one)


if __name__ == "__main__":
    unittest.main()
