"""Kinds of attacks of tests/attack.py."""
