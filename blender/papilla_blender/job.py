# SPDX-License-Identifier: GPL-3.0-or-later
"""Long calls: beside Blender's window, with progress and Esc, or at once where there is no window."""
import threading

import bpy

from .engine import Cancelled, EngineError


class Job:
    """Runs `work(progress)` in a thread, which must not touch bpy."""

    def __init__(self, work):
        self.stage, self.fraction = "", 0.0
        self._cancelled = threading.Event()
        self._result = self._error = None
        self._thread = threading.Thread(target=self._run, args=(work,), name="papilla job", daemon=True)
        self._thread.start()

    def _run(self, work):
        try:
            self._result = work(self._progress)
        except BaseException as error:  # comes out of result()
            self._error = error

    def _progress(self, stage, fraction):
        self.stage, self.fraction = stage, fraction
        return not self._cancelled.is_set()

    def cancel(self):
        self._cancelled.set()

    def is_running(self):
        return self._thread.is_alive()

    def result(self):
        self._thread.join()
        if self._error is not None:
            raise self._error
        return self._result


class LongOperator:
    """An operator of three steps: `prepare(context)` looks at the scene and returns the work, a function of a progress
    callback that does not touch bpy; `finish(context, result)` changes the scene. Esc cancels, and changes nothing.
    """

    _job = _timer = None

    def prepare(self, context):
        raise NotImplementedError

    def finish(self, context, result):
        raise NotImplementedError

    def invoke(self, context, event):
        if bpy.app.background:
            return self.execute(context)
        work = self._guarded(lambda: self.prepare(context))
        if work is None:
            return {"CANCELLED"}
        self._job = Job(work)
        self._timer = context.window_manager.event_timer_add(0.1, window=context.window)
        context.window_manager.progress_begin(0, 100)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC" and event.value == "PRESS":
            self._job.cancel()
            context.workspace.status_text_set("Papilla: cancelling")
            return {"RUNNING_MODAL"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        if self._job.is_running():
            percent = round(100 * self._job.fraction)
            context.window_manager.progress_update(percent)
            context.workspace.status_text_set(f"{self.bl_label}: {self._job.stage} {percent} %, Esc cancels")
            return {"RUNNING_MODAL"}
        self._end(context)
        return self._conclude(context, self._job.result)

    def execute(self, context):
        work = self._guarded(lambda: self.prepare(context))
        if work is None:
            return {"CANCELLED"}
        return self._conclude(context, lambda: work(None))

    def cancel(self, context):
        """Blender closes."""
        if self._job:
            self._job.cancel()
            self._end(context)

    def _end(self, context):
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        context.workspace.status_text_set(None)

    def _conclude(self, context, result):
        def finish():
            self.finish(context, result())
            return True

        return {"FINISHED"} if self._guarded(finish) else {"CANCELLED"}

    def _guarded(self, step):
        """What the step returns; None when it failed, which is reported."""
        try:
            return step()
        except Cancelled:
            self.report({"INFO"}, "Cancelled")
        except (EngineError, OSError) as error:
            self.report({"ERROR"}, str(error))
        return None
