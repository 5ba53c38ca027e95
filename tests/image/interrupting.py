# SPDX-License-Identifier: Apache-2.0
"""Ctrl-C at a moment that a command's messages tell of, for the tests beside this module."""

import os
import signal
import subprocess


def interrupt(command, line_start, environment=None):
    """Runs a command and interrupts it when a line of standard error starts so. environment: variables beside this process's own.
    Returns exit code, standard output and standard error."""
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                               env={**os.environ, **(environment or {})})
    messages = ""
    try:
        for line in process.stderr:
            messages += line
            if line.startswith(line_start):
                process.send_signal(signal.SIGINT)
                break
        output, rest = process.communicate(timeout=240)
    finally:
        process.kill()
        process.wait()
    return process.returncode, output, messages + rest
