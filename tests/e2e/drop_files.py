#!/usr/bin/env python3
"""Drops files on a window as a file manager does (XDND): drop_files.py WINDOW FILE...

Exit status: 0 taken, 1 refused or no answer, 77 no Xlib here.
"""
import ctypes as c
import os
import sys
import time
import urllib.parse

try:
    x = c.CDLL("libX11.so.6")
except OSError:
    sys.exit(77)

CLIENT_MESSAGE, SELECTION_REQUEST, SELECTION_NOTIFY = 33, 30, 31


class ClientMessage(c.Structure):
    _fields_ = [("type", c.c_int), ("serial", c.c_ulong), ("sent", c.c_int), ("display", c.c_void_p),
                ("window", c.c_ulong), ("message", c.c_ulong), ("format", c.c_int), ("data", c.c_long * 5)]


class SelectionRequest(c.Structure):
    _fields_ = [("type", c.c_int), ("serial", c.c_ulong), ("sent", c.c_int), ("display", c.c_void_p),
                ("owner", c.c_ulong), ("requestor", c.c_ulong), ("selection", c.c_ulong), ("target", c.c_ulong),
                ("property", c.c_ulong), ("time", c.c_ulong)]


class SelectionNotify(c.Structure):
    _fields_ = [("type", c.c_int), ("serial", c.c_ulong), ("sent", c.c_int), ("display", c.c_void_p),
                ("requestor", c.c_ulong), ("selection", c.c_ulong), ("target", c.c_ulong), ("property", c.c_ulong),
                ("time", c.c_ulong)]


class Event(c.Union):
    _fields_ = [("type", c.c_int), ("client", ClientMessage), ("request", SelectionRequest),
                ("notify", SelectionNotify), ("pad", c.c_long * 24)]


x.XOpenDisplay.restype = c.c_void_p
x.XDefaultRootWindow.argtypes = [c.c_void_p]
x.XDefaultRootWindow.restype = c.c_ulong
x.XCreateSimpleWindow.argtypes = [c.c_void_p, c.c_ulong] + [c.c_int] * 2 + [c.c_uint] * 3 + [c.c_ulong] * 2
x.XCreateSimpleWindow.restype = c.c_ulong
x.XInternAtom.argtypes = [c.c_void_p, c.c_char_p, c.c_int]
x.XInternAtom.restype = c.c_ulong
x.XSetSelectionOwner.argtypes = [c.c_void_p, c.c_ulong, c.c_ulong, c.c_ulong]
x.XSendEvent.argtypes = [c.c_void_p, c.c_ulong, c.c_int, c.c_long, c.POINTER(Event)]
x.XChangeProperty.argtypes = [c.c_void_p, c.c_ulong, c.c_ulong, c.c_ulong, c.c_int, c.c_int, c.c_char_p, c.c_int]
x.XNextEvent.argtypes = [c.c_void_p, c.POINTER(Event)]
x.XPending.argtypes = [c.c_void_p]
x.XFlush.argtypes = [c.c_void_p]

target = int(sys.argv[1], 0)
uris = "".join("file://" + urllib.parse.quote(os.path.abspath(path)) + "\r\n" for path in sys.argv[2:]).encode()
display = x.XOpenDisplay(None)
own = x.XCreateSimpleWindow(display, x.XDefaultRootWindow(display), 0, 0, 1, 1, 0, 0, 0)


def atom(name):
    return x.XInternAtom(display, name.encode(), 0)


def send(message, *data):
    event = Event()
    event.client = ClientMessage(CLIENT_MESSAGE, 0, 1, display, target, atom(message), 32, (c.c_long * 5)(own, *data))
    x.XSendEvent(display, target, 0, 0, c.byref(event))
    x.XFlush(display)


def await_message(wanted):
    """Answers requests for the list until the window sends `wanted`; its data, or None after ten seconds."""
    until = time.time() + 10
    event = Event()
    while time.time() < until:
        if not x.XPending(display):
            time.sleep(0.02)
            continue
        x.XNextEvent(display, c.byref(event))
        if event.type == CLIENT_MESSAGE and event.client.message == atom(wanted):
            return list(event.client.data)
        if event.type == SELECTION_REQUEST:
            asked = event.request
            x.XChangeProperty(display, asked.requestor, asked.property, asked.target, 8, 0, uris, len(uris))
            answer = Event()
            answer.notify = SelectionNotify(SELECTION_NOTIFY, 0, 1, display, asked.requestor, asked.selection,
                                            asked.target, asked.property, asked.time)
            x.XSendEvent(display, asked.requestor, 0, 0, c.byref(answer))
            x.XFlush(display)
    return None


x.XSetSelectionOwner(display, atom("XdndSelection"), own, 0)
send("XdndEnter", 5 << 24, atom("text/uri-list"), 0, 0)
send("XdndPosition", 0, (300 << 16) | 300, 0, atom("XdndActionCopy"))
status = await_message("XdndStatus")
if not status or not status[1] & 1:
    sys.exit(1)
send("XdndDrop", 0, 0, 0, 0)
finished = await_message("XdndFinished")
sys.exit(0 if finished else 1)
