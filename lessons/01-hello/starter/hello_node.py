import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class HelloNode(Node):
    def __init__(self):
        super().__init__("hello")
        # MISSING: a greeting in the log.
        # НЕ ХВАТАЕТ: приветствия в журнале.
        # MISSING: the parameter "period", 1.0 by default.
        # НЕ ХВАТАЕТ: параметра "period", по умолчанию 1.0.
        # MISSING: self.count, and a timer that calls self.tick once a period.
        # НЕ ХВАТАЕТ: self.count и таймера, который раз в период вызывает self.tick.

    def tick(self):
        # MISSING: count one more, and log the number.
        # НЕ ХВАТАЕТ: увеличить счётчик на один и записать число в журнал.
        pass


def main(args=None):
    rclpy.init(args=args)
    # MISSING: make the node and let it spin; on Ctrl-C, end without an error.
    # НЕ ХВАТАЕТ: создать узел и запустить spin; по Ctrl-C завершиться без ошибки.
    rclpy.shutdown()


if __name__ == "__main__":
    main()
