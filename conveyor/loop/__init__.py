"""The loop of the belt: tensions, drives, take-up, curves, starting and stopping, strength."""
