"""Runs when the Pico is powered on."""

import config
from board import Board, Usb
from control import Control


def serve(board, control):
    """Run one round: take every byte that has come, then do what is due."""
    for _ in range(256):
        octet = board.read()
        if octet is None:
            break
        control.feed(octet)
    control.step()
    board.alive()


def main():
    """Obey the computer until power-off."""
    board = Board(config, Usb())
    try:
        control = Control(board, config)
        board.watch(control.guard)
        while True:
            serve(board, control)
    finally:
        board.off()


if __name__ == "__main__":
    main()
